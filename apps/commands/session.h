// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/cli/console.h"
#include "apps/cli/exit_code.h"
#include "apps/cli/interrupt.h"

namespace petzval {

/// What the program hands to its commands: where they talk to, what stops them, and the exit code
/// of one that ends without an exception.
struct Session {
    Interrupt interrupt;  ///< first: the threads of the others inherit its blocked signals
    Console console;
    std::vector<std::string> words;  ///< of the command line, without the program's name
    int exit_code = kSuccess;

    Session(ConsoleStyle style, bool quiet) : console(style, quiet) {}
};

}  // namespace petzval
