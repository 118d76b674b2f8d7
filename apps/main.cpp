// SPDX-License-Identifier: Apache-2.0
// petzval: photographs glTF scenes.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "apps/cli/command_line.h"
#include "apps/cli/console.h"
#include "apps/commands/chart.h"
#include "apps/commands/image.h"
#include "apps/commands/info.h"
#include "apps/commands/lens.h"
#include "apps/commands/plan.h"
#include "apps/commands/render.h"
#include "apps/setup/develop.h"
#include "io/base/error.h"

namespace {

constexpr int kFailure = 1, kBadArguments = 2;

int fail(int exit_code, const std::string& what) {
    petzval::print_error_line("petzval: error: " + what);
    return exit_code;
}

// Exit code where parsing stopped. Help and the version are "errors" to CLI11 as well.
int stop_parsing(const CLI::App& app, const CLI::ParseError& e, const petzval::Spelling& line) {
    if (e.get_exit_code() == 0) return app.exit(e);
    return fail(kBadArguments, petzval::explanation(app, e, line) + " (--help says more)");
}

int run(CLI::App& app, int argc, char** argv, const int& exit_code) {
    petzval::Spelling line = petzval::with_current_spellings(argc, argv);
    try {
        petzval::resolve_help(app, line);
        // CLI11 takes the words from the end of a vector.
        app.parse(std::vector<std::string>(line.words.rbegin(), line.words.rend()));
    } catch (const CLI::ParseError& e) {
        return stop_parsing(app, e, line);
    } catch (const petzval::ArgumentError& e) {
        return fail(kBadArguments, e.what());
    } catch (const std::bad_alloc&) {
        return fail(kFailure, "out of memory");
    } catch (const std::exception& e) {
        return fail(kFailure, e.what());
    }
    return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    // A limit on the size of files then fails a write, as a full disk does, instead of killing.
    std::signal(SIGXFSZ, SIG_IGN);
    CLI::App app("A path tracer whose camera is a lens. Every command has --help.");
    app.name("petzval");
    app.option_defaults()->take_last();  // of an option that is given twice
    app.set_version_flag("--version", petzval::program_version());
    app.require_subcommand(1);
    int exit_code = 0;
    petzval::add_render_command(app, exit_code);
    petzval::add_plan_command(app);
    petzval::add_chart_command(app, exit_code);
    petzval::add_info_command(app);
    petzval::add_image_commands(app);
    petzval::add_lens_commands(app);
    app.footer("petzval help COMMAND prints what a command takes.");
    const int result = run(app, argc, argv, exit_code);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        return fail(kFailure, "standard output cannot be written");
    return result;
}
