// SPDX-License-Identifier: Apache-2.0
// petzval: photographs glTF scenes.
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "apps/cli/command_line.h"
#include "apps/commands/all.h"
#include "apps/commands/failure.h"
#include "apps/commands/resume.h"
#include "apps/commands/session.h"
#include "apps/request/value_error.h"

namespace {

namespace apps = petzval::apps;

using apps::Session;

constexpr const char* kMore = " (--help says more)";

int fail(Session& session, int exit_code, const std::string& what) {
    session.console.error(what);
    return exit_code;
}

// Exit code where parsing stopped. Help and the version are "errors" to CLI11 as well.
int stop_parsing(Session& session, const CLI::App& app, const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    return fail(session, apps::kUsage, apps::explanation(app, e) + kMore);
}

int run(CLI::App& app, std::vector<std::string> words, Session& session) {
    try {
        apps::resolve_help(app, words);
        // CLI11 takes the words from the end of a vector.
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& e) {
        return stop_parsing(session, app, e);
    } catch (const apps::ValueError& e) {
        return fail(session, apps::kUsage, std::string(e.what()) + kMore);
    } catch (...) {
        return apps::tell_failure(session);
    }
    return session.exit_code;
}

// Whether nobody reads standard output any more, as after head: it has what it wanted.
bool stdout_reader_has_gone() {
    pollfd out{STDOUT_FILENO, POLLOUT, 0};
    return ::poll(&out, 1, 0) == 1 && (out.revents & (POLLERR | POLLHUP)) != 0;
}

// Exit code once what is left of standard output is written.
int finish_stdout(Session& session, int exit_code) {
    const bool flushed = std::fflush(stdout) == 0;
    if ((flushed && std::ferror(stdout) == 0) || stdout_reader_has_gone()) return exit_code;
    return fail(session, apps::kOutputFailed, "standard output cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
    // A limit on the size of files then fails a write, as a full disk does, and so does a pipe
    // whose reader has gone, instead of killing.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    std::vector<std::string> words(argv + 1, argv + argc);
    const apps::ConsoleWish wish = apps::console_wish_of(words);
    Session session(wish.style, wish.quiet);
    CLI::App app;
    apps::add_all_commands(app, session);
    const int exit_code = finish_stdout(session, run(app, std::move(words), session));
    session.console.end(exit_code);
    return exit_code;
}
