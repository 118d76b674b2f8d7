// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace petzval {

/// Receives one line of text for the user: what was chosen for him, or what is odd.
using Notice = std::function<void(const std::string&)>;

}  // namespace petzval
