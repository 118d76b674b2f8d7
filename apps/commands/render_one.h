// SPDX-License-Identifier: Apache-2.0
// Render of one picture: from the options to its files.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "apps/commands/session.h"
#include "apps/render/render_session.h"
#include "apps/request/render_order.h"
#include "io/base/notice.h"

namespace petzval::apps {

/// Choices that a picture was rendered with, where its order leaves them open: else the view, the
/// focus and the brightness would jump from picture to picture.
struct FoundChoices {
    std::optional<std::array<V3f, 2>> look_at;
    std::optional<V3f> orbit_about;
    std::optional<Focus> focus;
    std::optional<float> exposure_ev;
};

/// A picture of a sequence, and what it shares with those beside it.
struct SequencePlace {
    std::pair<int, int> part_of{0, 1};  ///< its number from 0, of so many
    /// That of the pictures before, or null; afterwards that of this one.
    std::unique_ptr<RenderSession> render{};
    RenderSession::Frames frames = RenderSession::Frames::Single;
    /// Choices that this picture found, for others to use.
    FoundChoices found;
    /// Gets the picture for a display when it is finished, or was there already.
    std::function<void(const io::PictureRows&, const io::DisplayOptions&)> show;
};

/// Renders one picture and writes its files. resumed_from: a state whose samples it goes on from.
/// The exit code. Throws what setting up throws.
[[nodiscard]] int render_one(const RenderOrder&,
                             const std::optional<std::filesystem::path>& resumed_from,
                             const io::Notice& notice, Session&, SequencePlace&);

}  // namespace petzval::apps
