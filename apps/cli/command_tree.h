// SPDX-License-Identifier: Apache-2.0
// The table of commands and options, as it may be asked.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace petzval::apps {

/// Commands right below one.
[[nodiscard]] inline std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands(std::function<bool(const CLI::App*)>());
}

/// "petzval lens spot".
[[nodiscard]] inline std::string full_name(const CLI::App& app) {
    return (app.get_parent() ? full_name(*app.get_parent()) + " " : "") + app.get_name();
}

/// Whether it is an option, not an argument by its place.
[[nodiscard]] inline bool is_named(const CLI::Option& option) {
    return !option.get_lnames().empty() || !option.get_snames().empty();
}

[[nodiscard]] inline std::vector<const CLI::Option*> options_of(const CLI::App& app) {
    return app.get_options([](const CLI::Option* o) { return is_named(*o); });
}

[[nodiscard]] inline std::vector<const CLI::Option*> arguments_of(const CLI::App& app) {
    return app.get_options([](const CLI::Option* o) { return !is_named(*o); });
}

/// Names as they are typed: -o, --output. Empty for an argument.
[[nodiscard]] inline std::vector<std::string> names_of(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

[[nodiscard]] inline bool takes_value(const CLI::Option& option) {
    return option.get_expected_max() > 0;
}

/// Whether its values may be names of files: they are no numbers, and not one of some words.
[[nodiscard]] inline bool may_take_file(const CLI::Option& option) {
    for (const char* other : {"NUMBER", "INT", "FLOAT", "WORD"})
        if (option.get_type_name().find(other) != std::string::npos) return false;
    return true;
}

}  // namespace petzval::apps
