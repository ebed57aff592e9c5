#include "tools/cli/subcommand_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

std::string count_complaint(const std::string& text, std::uint64_t most) {
  const auto count = parse_count(text);
  if (!count) return count.error().text;
  return *count <= most ? std::string()
                        : fmt::format("{} is too large; give at most {}", *count, most);
}

std::string bytes_complaint(const std::string& text) {
  const auto bytes = parse_bytes(text);
  return bytes ? std::string() : std::string(bytes.error().text);
}

std::string length_complaint(const std::string& text, bool infinite) {
  double value = 0;
  if (octree::parse_real(text, value) && value >= 0 && (infinite || std::isfinite(value)))
    return {};
  return fmt::format("'{}' is not a length; give a number of 0 or more, in model units",
                     octree::printable(text));
}

}  // namespace

SubcommandOptions::SubcommandOptions(CLI::App& app, const std::string& name,
                                     const std::string& help)
    : subcommand_(*app.add_subcommand(name, help)) {}

SubcommandOptions::Option SubcommandOptions::path(const std::string& name, const char* type,
                                                  std::filesystem::path& value,
                                                  const std::string& help) {
  const auto accept = [](std::string&) { return std::string(); };
  return subcommand_.add_option(name, value, help)
      ->type_name(type)
      ->check(CLI::Validator(accept, "", kPathCheck));
}

SubcommandOptions::Option SubcommandOptions::paths(const std::string& name, const char* type,
                                                   std::vector<std::filesystem::path>& values,
                                                   const std::string& help) {
  const auto accept = [](std::string&) { return std::string(); };
  return subcommand_.add_option(name, values, help)
      ->type_name(type)
      ->expected(1, CLI::detail::expected_max_vector_size)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(CLI::Validator(accept, "", kPathCheck));
}

SubcommandOptions::Option SubcommandOptions::flag(const std::string& name, bool& value,
                                                  const std::string& help) {
  return subcommand_.add_flag(name, value, help);
}

SubcommandOptions::Option SubcommandOptions::bytes(const std::string& name, std::uint64_t& value,
                                                   const std::string& help) {
  const auto take = [&value](const std::string& given) { value = *parse_bytes(given); };
  return text(name, "SIZE", bytes_complaint, take, help);
}

SubcommandOptions::Option SubcommandOptions::count(const std::string& name, std::uint64_t& value,
                                                   std::uint64_t most, const std::string& help) {
  const auto complaint = [most](const std::string& given) { return count_complaint(given, most); };
  const auto take = [&value](const std::string& given) { value = *parse_count(given); };
  return text(name, "N", complaint, take, help);
}

SubcommandOptions::Option SubcommandOptions::count_and_path(
    const std::string& name, const char* type, std::uint64_t& value, std::uint64_t most,
    std::filesystem::path& path, std::function<std::string(const std::string&)> complaint,
    const std::string& help) {
  const auto take = [&value, &path](const std::vector<std::string>& given) {
    value = *parse_count(given[0]);
    path = given[1];
  };
  const auto check_count = [most](std::string& given) { return count_complaint(given, most); };
  const auto check_path = [complaint](std::string& given) { return complaint(given); };
  return subcommand_.add_option_function<std::vector<std::string>>(name, take, help)
      ->type_name(type)
      ->type_size(2)
      ->expected(1)
      ->check(CLI::Validator(check_count, "", "").application_index(0))
      ->check(CLI::Validator(check_path, "", kPathCheck).application_index(1));
}

SubcommandOptions::Option SubcommandOptions::length(const std::string& name, double& value,
                                                    bool infinite, const std::string& help) {
  const auto complaint = [infinite](const std::string& given) {
    return length_complaint(given, infinite);
  };
  const auto take = [&value](const std::string& given) { octree::parse_real(given, value); };
  return text(name, "LENGTH", complaint, take, help);
}

SubcommandOptions::Option SubcommandOptions::word(const std::string& name,
                                                  const std::vector<std::string>& words,
                                                  std::function<void(const std::string&)> take,
                                                  const std::string& help) {
  return subcommand_.add_option_function<std::string>(name, take, help)
      ->type_name(fmt::format("{}", fmt::join(words, "|")))
      ->check(CLI::IsMember(words).description(""));
}

SubcommandOptions::Option SubcommandOptions::text(
    const std::string& name, const char* type,
    std::function<std::string(const std::string&)> complaint,
    std::function<void(const std::string&)> take, const std::string& help) {
  return subcommand_.add_option_function<std::string>(name, take, help)
      ->type_name(type)
      ->check(CLI::Validator([complaint](std::string& given) { return complaint(given); }, "", ""));
}

SubcommandOptions::Option SubcommandOptions::texts(
    const std::string& name, const char* type,
    std::function<std::string(const std::string&)> complaint, std::vector<std::string>& values,
    const std::string& help) {
  return subcommand_.add_option(name, values, help)
      ->type_name(type)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check(CLI::Validator([complaint](std::string& given) { return complaint(given); }, "", ""));
}

SubcommandOptions::Option SubcommandOptions::require(Option option) { return option->required(); }

SubcommandOptions::Option SubcommandOptions::default_text(Option option, const std::string& text) {
  return option->default_str(text);
}

void SubcommandOptions::need(Option option, Option other) { option->needs(other); }

void SubcommandOptions::exclude(Option option, Option other) { option->excludes(other); }

bool SubcommandOptions::given(Option option) { return option->count() > 0; }

void SubcommandOptions::on_given(std::function<std::string()> act) {
  subcommand_.callback([act] {
    const std::string complaint = act();
    if (!complaint.empty()) throw CLI::ValidationError(complaint);
  });
}

}  // namespace planetree::tools
