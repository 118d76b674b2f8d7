// SPDX-License-Identifier: Apache-2.0
// Values that are one of a few words.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

#include "apps/request/option_names.h"
#include "apps/request/value_error.h"
#include "io/base/ascii.h"
#include "io/base/nearest.h"

namespace petzval::apps {

template <class T>
using Choices = std::vector<std::pair<std::string, T>>;

/// Names and values of a choice, from option_names.h.
template <class T>
[[nodiscard]] Choices<T> choices_of() {
    Choices<T> choices;
    for (const auto& [name, value] : kOptionNames<T>) choices.emplace_back(name, value);
    return choices;
}

/// Value of a word, whatever its case. Throws ValueError, which lists the words.
template <class T>
[[nodiscard]] T parse_choice(const std::string& option, const std::string& text,
                             const Choices<T>& choices) {
    std::vector<std::string> known;
    for (const auto& [word, choice] : choices) {
        if (word == io::lower(text)) return choice;
        known.push_back(word);
    }
    throw ValueError(option, fmt::format("\"{}\" is none of {}{}", text, fmt::join(known, ", "),
                                         io::did_you_mean(text, known)));
}

}  // namespace petzval::apps
