// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/render/render_session.h"
#include "apps/setup/camera/camera_report.h"
#include "io/file/overwrite.h"
#include "io/picture/picture.h"
#include "io/picture/picture_kind.h"

namespace petzval::apps {

/// Picture of a finished render with all that its files say, apart from the session that made it.
class RenderedImage {
  public:
    /// Takes what the session holds now.
    RenderedImage(const RenderSession&, const SceneRequest&, std::vector<std::string> notices);

    /// Layout of the EXR, whose channels the values have, and the values, row by row.
    [[nodiscard]] const io::PictureLayout& layout() const {
        return layout_of(io::PictureFormat::Exr);
    }
    [[nodiscard]] const std::vector<float>& values() const { return values_; }
    [[nodiscard]] const CameraReport& camera() const { return camera_; }
    /// Focal lengths in pixels, across and upright, at the focus that is set; nothing where the
    /// camera is orthographic.
    [[nodiscard]] const std::optional<std::array<double, 2>>& focal_px() const { return focal_px_; }
    [[nodiscard]] const std::vector<std::string>& notices() const { return notices_; }

    /// Writes it as the command line does. Throws InputError; ArgumentError where that would
    /// destroy an input.
    void save(const std::filesystem::path&) const;
    /// R, G, B, A as a display shows them, in [0, 1] but for what the view lets out of it.
    [[nodiscard]] io::Picture shown() const;

  private:
    [[nodiscard]] const io::PictureLayout& layout_of(io::PictureFormat format) const {
        return layouts_[static_cast<size_t>(format)];
    }
    [[nodiscard]] io::PictureRows rows(io::PictureFormat) const;

    std::array<io::PictureLayout, 3> layouts_;  ///< by format: each file says other things
    std::vector<float> values_;
    io::DisplayOptions display_;
    CameraReport camera_;
    std::optional<std::array<double, 2>> focal_px_;
    std::vector<io::NamedFile> inputs_;
    std::vector<std::string> notices_;
};

}  // namespace petzval::apps
