// SPDX-License-Identifier: Apache-2.0
// petzval: photographs glTF scenes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>

#include "apps/image.h"
#include "apps/info.h"
#include "apps/render.h"
#include "io/develop.h"

namespace {

constexpr int kBadArguments = 2, kFailure = 1;

int fail(const char* what) {
    fmt::print(stderr, "petzval: error: {}\n", what);
    return kFailure;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("A path tracer whose camera is a lens. Every subcommand has --help.");
    app.name("petzval");
    app.set_version_flag("--version", petzval::program_version());
    app.require_subcommand(1);
    int exit_code = 0;
    petzval::add_render_command(app, exit_code);
    petzval::add_info_command(app);
    petzval::add_image_commands(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : kBadArguments;
    } catch (const std::bad_alloc&) {
        return fail("out of memory");
    } catch (const std::exception& e) {
        return fail(e.what());
    }
    return exit_code;
}
