// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace petzval::io {

/// Receives one line of text for the user: a choice made without being asked, or something odd.
using Notice = std::function<void(const std::string&)>;

}  // namespace petzval::io
