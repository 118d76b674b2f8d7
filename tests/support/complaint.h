// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace petzval::test {

/// The message of the std::invalid_argument that action() throws; "none" where it throws nothing.
[[nodiscard]] std::string complaint(const auto& action) {
    try {
        action();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "none";
}

}  // namespace petzval::test
