// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "io/base/error.h"

namespace petzval {

/// The message with which action() refuses its input; empty, and a failure, when it does not.
/// Any exception other than InputError fails the test by escaping.
template <class Action>
std::string refusal(Action action) {
    try {
        action();
    } catch (const io::InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "was not refused";
    return {};
}

/// Whether text holds part; says both when not.
inline testing::AssertionResult has(const std::string& text, const std::string& part) {
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "\"" << text << "\" does not hold \"" << part << "\"";
}

}  // namespace petzval
