#include "tools/view/view_request.h"

#include <charconv>
#include <cmath>
#include <span>

namespace planetree::tools {
namespace {

/// A parameter and where its value goes.
struct Parameter {
  std::string_view name;
  double* value;
  bool is_given = false;
};

bool read_number(std::string_view text, double& value) {
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end && std::isfinite(value);
}

bool read_parameter(std::string_view text, std::span<Parameter> parameters) {
  const std::size_t sign = text.find('=');
  if (sign == std::string_view::npos) return false;
  for (Parameter& parameter : parameters)
    if (parameter.name == text.substr(0, sign)) {
      if (parameter.is_given) return false;
      parameter.is_given = true;
      return read_number(text.substr(sign + 1), *parameter.value);
    }
  return false;
}

/// Reads `name=value&name=value`. Returns false if a parameter is unknown, bad or given twice.
bool read_parameters(std::string_view query, std::span<Parameter> parameters) {
  while (true) {
    const std::size_t end = query.find('&');
    if (!read_parameter(query.substr(0, end), parameters)) return false;
    if (end == std::string_view::npos) return true;
    query.remove_prefix(end + 1);
  }
}

/// Whether the parameters are all given.
bool has_all(std::span<const Parameter> parameters) {
  for (const Parameter& parameter : parameters)
    if (!parameter.is_given) return false;
  return true;
}

bool has_none(std::span<const Parameter> parameters) {
  for (const Parameter& parameter : parameters)
    if (parameter.is_given) return false;
  return true;
}

bool is_same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

}  // namespace

bool ShapeView::operator==(const ShapeView& other) const {
  return discs == other.discs && has_eye == other.has_eye && is_same(eye, other.eye) &&
         is_same(look, other.look) && cosine == other.cosine;
}

std::optional<ShapeView> parse_shape_view(std::string_view query) {
  ShapeView view;
  double discs = 0;
  Parameter parameters[] = {{"discs", &discs},    {"x", &view.eye.x},      {"y", &view.eye.y},
                            {"z", &view.eye.z},   {"dx", &view.look.x},    {"dy", &view.look.y},
                            {"dz", &view.look.z}, {"cosine", &view.cosine}};
  if (!read_parameters(query, parameters) || !parameters[0].is_given) return std::nullopt;
  const std::span<const Parameter> of_eye(parameters + 1, std::end(parameters));
  view.has_eye = has_all(of_eye);
  if (!view.has_eye && !has_none(of_eye)) return std::nullopt;
  if (discs != std::floor(discs) || discs < 1 || discs > ShapeView::kMaxDiscs) return std::nullopt;
  if (view.cosine < -1 || view.cosine > 1) return std::nullopt;
  const double longest =
      std::fmax(std::fabs(view.look.x), std::fmax(std::fabs(view.look.y), std::fabs(view.look.z)));
  if (view.has_eye && longest == 0) return std::nullopt;
  view.discs = static_cast<std::uint32_t>(discs);
  return view;
}

std::optional<PointQuestion> parse_point_question(std::string_view query) {
  PointQuestion question;
  Parameter parameters[] = {{"x", &question.point.x},
                            {"y", &question.point.y},
                            {"z", &question.point.z},
                            {"within", &question.within}};
  if (!read_parameters(query, parameters) || !has_all(parameters)) return std::nullopt;
  if (question.within < 0) return std::nullopt;
  return question;
}

}  // namespace planetree::tools
