// SPDX-License-Identifier: Apache-2.0
// Things of a file that a user names.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace petzval::io {

/// Index of the first thing that has this name, as it stands or as messages show it; else of the
/// one with this number. Absent where there is none.
[[nodiscard]] std::optional<size_t> find_named(const std::string& wanted,
                                               const std::vector<std::string>& names);

/// Names with their numbers for a message: 0 "red", 1 "blue" and 3 more. Empty where there are
/// none.
[[nodiscard]] std::string numbered(const std::vector<std::string>& names);

/// Error text for a thing that is not there, with what there is. kind: "camera"; otherwise: what to
/// say where there are none.
[[nodiscard]] std::string no_such(const std::string& kind, const std::string& wanted,
                                  const std::vector<std::string>& names,
                                  const std::string& otherwise);

}  // namespace petzval::io
