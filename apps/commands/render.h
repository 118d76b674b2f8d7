// SPDX-License-Identifier: Apache-2.0
// petzval render.
#pragma once

#include <filesystem>
#include <optional>

#include "apps/commands/session.h"
#include "apps/request/render_order.h"

namespace CLI {
class App;
}

namespace petzval::apps {

/// Declares the command; its exit code goes to the session, which must outlive the app.
void add_render_command(CLI::App&, Session&);

/// Renders a picture or a sequence. resumed_from: a state whose samples it goes on from. The exit
/// code.
[[nodiscard]] int run_render(const RenderOrder&, Session&,
                             const std::optional<std::filesystem::path>& resumed_from = {});

}  // namespace petzval::apps
