// SPDX-License-Identifier: Apache-2.0
// An option whose value is one of a few words.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/setup/option_names.h"
#include "io/base/ascii.h"
#include "io/base/nearest.h"

namespace petzval {

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

/// Names and values of a choice, from option_names.h.
template <class T>
[[nodiscard]] Choices<T> choices_of() {
    Choices<T> choices;
    for (const auto& [name, value] : kOptionNames<T>) choices.emplace_back(name, value);
    return choices;
}

/// Adds an option whose value is one of the choices, whatever the case. Any other word ends with
/// exit code 2 and the list of the known ones. value, a T or something that one can be assigned to,
/// must outlive parsing.
template <class T, class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const Choices<T>& choices, const std::string& help) {
    const auto read = [=, &value](const std::string& text) {
        std::vector<std::string> known;
        for (const auto& [word, choice] : choices) {
            if (word == lower(text)) {
                value = choice;
                return;
            }
            known.push_back(word);
        }
        throw CLI::ValidationError(
            name, fmt::format("\"{}\" is none of {}{}", text, fmt::join(known, ", "),
                              did_you_mean(text, known)));
    };
    return app.add_option_function<std::string>(name, read, help);
}

/// Adds an option with the names that option_names.h has for the choice.
template <class T, class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const std::string& help) {
    return add_choice<T>(app, name, value, choices_of<T>(), help);
}

}  // namespace petzval
