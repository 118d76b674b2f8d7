// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace petzval {

/// What of a glTF file is shown, where it leaves a choice.
struct GltfChoices {
    std::optional<std::string> variant;  ///< of its materials, by name or number; absent: none

    [[nodiscard]] bool operator==(const GltfChoices&) const = default;
};

}  // namespace petzval
