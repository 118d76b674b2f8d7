// SPDX-License-Identifier: Apache-2.0
// Rays to targets of a traced lens, in world space and for each way of carrying wavelengths.
#pragma once

#include <memory>

#include "camera/models/lens_camera.h"
#include "camera/target_camera.h"
#include "camera/targets/lens_targets.h"

namespace petzval {

class LensTargetCamera final : public TargetCamera {
  public:
    explicit LensTargetCamera(std::shared_ptr<const LensCamera>);

    [[nodiscard]] std::optional<PreparedTarget> prepared(const Target&) const override;
    [[nodiscard]] std::optional<ListedTarget> listed(const PreparedTarget&,
                                                     const FilmCell&) const override;
    void sample_beside(std::span<const FilmPoint>, std::span<const Bands>,
                       std::span<const TargetList>, std::span<CameraSample>) const override;
    void sample_targets(std::span<const FilmPoint>, std::span<const Bands>,
                        std::span<const TargetList>, std::span<CameraSample>) const override;

  private:
    using Batch = LensCamera::Batch;
    /// Density of rays to targets in the directions of rays, 1/sr of projected solid angle at the
    /// film.
    [[nodiscard]] std::array<float, kMostFilmPoints> to_targets(
        const Batch&, const LeadRays&, const std::array<TargetList, kMostFilmPoints>&) const;
    static void weigh(std::span<CameraSample>,
                      const std::array<float, kMostFilmPoints>& to_targets);

    std::shared_ptr<const LensCamera> camera_;
    LensTargets targets_;
};

}  // namespace petzval
