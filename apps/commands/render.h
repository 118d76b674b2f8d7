// SPDX-License-Identifier: Apache-2.0
// petzval render.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/cli/render_options.h"
#include "apps/commands/session.h"

namespace CLI {
class App;
}

namespace petzval {

/// Declares the command; its exit code goes to the session, which must outlive the app.
void add_render_command(CLI::App&, Session&);

/// Options of a render from the words of its command line.
struct ParsedRender {
    std::unique_ptr<CLI::App> app;  ///< the options point into it
    std::unique_ptr<RenderOptions> options;
};

/// Parses the words of a render, "render" first. Throws CLI::ParseError.
[[nodiscard]] ParsedRender parse_render(const std::vector<std::string>& words);

/// Renders a picture or a sequence. session.words: the command, by which a state is resumed. The
/// exit code.
[[nodiscard]] int run_render(RenderOptions&, Session&);

}  // namespace petzval
