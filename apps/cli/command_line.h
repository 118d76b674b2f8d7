// SPDX-License-Identifier: Apache-2.0
// The command line as a whole: help in words, and what to say where it is not understood.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace petzval::apps {

/// Makes every command that writes one file refuse two outputs, of which one would be lost. Of
/// other options that are given twice the last holds.
void resolve_repeats(CLI::App&);

/// Writes "petzval help render" and "petzval lens help spot" as the --help that they mean, which
/// has all options where "all" follows. Throws
/// CLI::ParseError where help is wanted about what is no command.
void resolve_help(CLI::App&, std::vector<std::string>& words);

/// Error of an option that a command does not have, with what may have been meant.
[[nodiscard]] CLI::ParseError no_such_option(const CLI::App&, const std::string& option);

/// Explanation of why words were not parsed, with what may have been meant.
[[nodiscard]] std::string explanation(const CLI::App&, const CLI::ParseError&);

}  // namespace petzval::apps
