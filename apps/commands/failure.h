// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/commands/session.h"

namespace petzval::apps {

/// Tells the exception that is being handled, after "WHERE: " where that is not empty; its exit
/// code. Call it in a catch block only.
[[nodiscard]] int tell_failure(Session&, const std::string& where = "");

}  // namespace petzval::apps
