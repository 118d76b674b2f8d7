// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/failure.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "io/base/error.h"

namespace petzval::apps {

int tell_failure(Session& session, const std::string& where) {
    const auto fail = [&](int exit_code, const std::string& what) {
        session.console.error(where.empty() ? what : where + ": " + what);
        return exit_code;
    };
    try {
        throw;
    } catch (const CLI::ParseError& e) {
        return fail(kUsage, e.what());
    } catch (const io::ArgumentError& e) {
        return fail(kUsage, e.what());
    } catch (const io::OutputError& e) {
        return fail(kOutputFailed, e.what());
    } catch (const std::bad_alloc& e) {
        const std::string what = e.what();
        return fail(kOutOfMemory, what == "std::bad_alloc" ? "out of memory" : what);
    } catch (const std::length_error&) {  // of a container: more than any memory
        return fail(kOutOfMemory, "out of memory");
    } catch (const std::system_error& e) {
        // fmt throws one where standard output cannot be written, which is told at the end.
        if (std::ferror(stdout) == 0) return fail(kFailure, e.what());
        return session.exit_code;
    } catch (const std::exception& e) {
        return fail(kFailure, e.what());
    }
}

}  // namespace petzval::apps
