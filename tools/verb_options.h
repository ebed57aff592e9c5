#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

/// Options that several verbs take, each read and refused in one way.
namespace planetree::tools {

/// A number of bytes: 4096, 64K, 1.5G.
CLI::Option* add_bytes_option(CLI::App& verb, const std::string& name, std::uint64_t& value,
                              const std::string& help);

/// A whole number: 5000, 20K; at most `most`.
CLI::Option* add_count_option(CLI::App& verb, const std::string& name, std::uint64_t& value,
                              std::uint64_t most, const std::string& help);

/// A length >= 0 in model units; infinite only where `infinite` says so.
CLI::Option* add_length_option(CLI::App& verb, const std::string& name, double& value,
                               bool infinite, const std::string& help);

}  // namespace planetree::tools
