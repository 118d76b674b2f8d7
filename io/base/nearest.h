// SPDX-License-Identifier: Apache-2.0
// Known words that a mistyped one may mean.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace petzval::io {

/// Edit distance: letters to insert, leave out or replace, and neighbours to exchange, no letter
/// twice. Damerau 1964, "A technique for computer detection and correction of spelling errors".
[[nodiscard]] size_t edit_distance(std::string_view a, std::string_view b);

/// Up to three of the known words that a text may mean, the nearest first, whatever the case: words
/// that it begins, contains or ends, and words within a third of its letters.
[[nodiscard]] std::vector<std::string> words_near(const std::string& text,
                                                  const std::vector<std::string>& known);

/// Question that follows an error: "; did you mean A or B?". Empty where no known word is near.
[[nodiscard]] std::string did_you_mean(const std::string& text,
                                       const std::vector<std::string>& known);

/// The same where something is near, else "; " and what there is: `there_are`, then the words.
[[nodiscard]] std::string did_you_mean_or(const std::string& there_are, const std::string& text,
                                          const std::vector<std::string>& known);

}  // namespace petzval::io
