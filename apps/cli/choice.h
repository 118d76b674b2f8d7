// SPDX-License-Identifier: Apache-2.0
// An option whose value is one of a few words.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "apps/request/parse_choice.h"

namespace petzval::apps {

/// Adds an option whose value is one of the choices, whatever the case. Any other word ends with
/// exit code 2 and the list of the known ones. value, a T or something that one can be assigned to,
/// must outlive parsing.
template <class T, class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const Choices<T>& choices, const std::string& help) {
    const auto read = [=, &value](const std::string& text) {
        value = parse_choice<T>(name, text, choices);
    };
    return app.add_option_function<std::string>(name, read, help);
}

/// Adds an option with the names that option_names.h has for the choice.
template <class T, class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const std::string& help) {
    return add_choice<T>(app, name, value, choices_of<T>(), help);
}

}  // namespace petzval::apps
