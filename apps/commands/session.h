// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/cli/console.h"
#include "apps/cli/exit_code.h"
#include "apps/cli/interrupt.h"

namespace petzval::apps {

/// Console, interrupt and exit code that the program hands to its commands. The exit code is of one
/// that ends without an exception.
struct Session {
    Interrupt interrupt;  ///< first: the threads of the others inherit its blocked signals
    Console console;
    int exit_code = kSuccess;

    Session(ConsoleStyle style, bool quiet) : console(style, quiet) {}
};

}  // namespace petzval::apps
