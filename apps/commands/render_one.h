// SPDX-License-Identifier: Apache-2.0
// Render of one picture: from the options to its files.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/cli/render_options.h"
#include "apps/commands/session.h"
#include "apps/render/render_session.h"
#include "io/base/notice.h"

namespace petzval {

/// A picture of a sequence, and what it shares with those beside it.
struct SequencePlace {
    std::pair<int, int> part_of{0, 1};  ///< its number from 0, of so many
    /// That of the pictures before, or null; afterwards that of this one.
    std::unique_ptr<RenderSession> render{};
    RenderSession::Frames frames = RenderSession::Frames::Single;
    /// Options that make other pictures use what this one found: view, focus, exposure.
    std::vector<std::string> found;
    /// Gets the picture for a display when it is finished, or was there already.
    std::function<void(const PictureRows&, const DisplayOptions&)> show;
};

/// Renders one picture and writes its files. command: the words that ask for it, by which a state
/// is resumed. The exit code. Throws what setting up throws.
[[nodiscard]] int render_one(RenderOptions&, const std::vector<std::string>& command,
                             const Notice& notice, Session&, SequencePlace&);

}  // namespace petzval
