// SPDX-License-Identifier: Apache-2.0
// A camera with a lens that shows the ghosts of its light.
#pragma once

#include <memory>

#include "camera/ghosts/ghost_draws.h"

namespace petzval::camera {

/// Rays of another camera and, together with them, rays on which light of two reflections reaches
/// the same film points: an estimate without a bias, as each draw is weighed by the density of
/// all (balance heuristic, Veach and Guibas 1995).
class GhostCamera final : public Camera {
  public:
    /// in_order: brings the light that no surface reflects, through the same lens; nullptr: ghosts
    /// alone are shown.
    GhostCamera(std::shared_ptr<const Camera> in_order, GhostOptics,
                std::shared_ptr<const GhostDraws>);

    [[nodiscard]] CameraSample sample(const FilmPoint& point, const Bands& bands) const override {
        return one_of_all(point, bands);
    }
    void sample_all(std::span<const FilmPoint>, std::span<const Bands>,
                    std::span<CameraSample>) const override;

  private:
    struct Place;
    void add_rays(const Place&, const GhostDraw&, m4 lanes, float effort, CameraSample&) const;
    void add_ghosts(const FilmPoint&, const Bands&, CameraSample&) const;

    std::shared_ptr<const Camera> in_order_;
    GhostOptics optics_;
    std::shared_ptr<const GhostDraws> draws_;
    LensIndices<f4> line_d_;
};

}  // namespace petzval::camera
