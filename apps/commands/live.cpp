// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/live.h"

#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>

#include "apps/cli/field_options.h"
#include "apps/live/live_server.h"
#include "apps/request/value_error.h"
#include "io/base/error.h"
#include "io/file/assets.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

// Opens an address as the desktop does; without a desktop, or where nobody watches, it does not.
void open_in_browser(const std::string& address) {
    if (!isatty(STDOUT_FILENO) || (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")))
        return;
    std::string program = "xdg-open", word = address;
    char* const words[] = {program.data(), word.data(), nullptr};
    posix_spawnattr_t apart;  // Ctrl-C here does not end the browser
    posix_spawnattr_init(&apart);
    posix_spawnattr_setflags(&apart, POSIX_SPAWN_SETSID);
    pid_t child = 0;
    posix_spawnp(&child, program.c_str(), nullptr, &apart, words, environ);
    posix_spawnattr_destroy(&apart);
}

std::string command_of(RenderOrder order) {
    order.run.outputs = {"picture.exr"};
    return render_command(order);
}

void serve(const LiveOptions& options, Session& session) {
    if (options.listen && options.listen->empty())
        throw ValueError("--listen", "needs an address, as 0.0.0.0");
    const auto& scene = options.start.render.scene.scene;
    if (std::error_code none; !std::filesystem::is_regular_file(scene, none))
        throw io::InputError(scene.string(), "", "no such file");
    io::load_image_codec();
    integrator::RenderMonitor& monitor = session.interrupt.monitor();
    session.interrupt.arm();
    const LiveServer server(options);
    fmt::print("{}\n", server.address());
    std::fflush(stdout);
    if (options.listen)
        session.console.notice(
            "whoever knows this address can use it, and it is not encrypted: not for open "
            "networks");
    else
        open_in_browser(server.address());
    session.console.notice("Ctrl-C ends it");
    while (!monitor.stop) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

}  // namespace

void add_live_command(CLI::App& app, Session& session) {
    auto options = std::make_shared<LiveOptions>();
    CLI::App* command =
        app.add_subcommand("live", "show a scene in the browser, to look for a picture");
    add_field_options(*command, options->start, kLive);
    command->get_option("SCENE")->required(false);
    command->add_flag("--learn", options->learn,
                      "a page to learn from, in place of a scene: blur, depth of field, bokeh and "
                      "aberrations, each with its formula and pictures");
    command->add_option("--port", options->port, "port of the address (default: a free one)")
        ->check(CLI::Range(0, 65535));
    command->add_option("--listen", options->listen,
                        "address to listen on, as 0.0.0.0, for a browser on another machine "
                        "(default: this machine alone)");
    command->callback([options, &session] {
        options->command = command_of;
        auto& file = options->start.render.scene.scene;
        if (options->learn != file.empty())
            throw ValueError("SCENE", options->learn ? "is none of --learn, which has its own"
                                                     : "is missing: give a .gltf or .glb file");
        if (options->learn) file = io::asset("scenes/ornaments.glb");
        serve(*options, session);
    });
}

}  // namespace petzval::apps
