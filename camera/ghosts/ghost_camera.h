// SPDX-License-Identifier: Apache-2.0
// A camera with a lens that shows the ghosts of its light.
#pragma once

#include <memory>
#include <vector>

#include "camera/ghosts/ghost_regions.h"

namespace petzval {

/// Rays of another camera and, together with them, rays on which light of two reflections reaches
/// the same film points: an estimate without a bias. Some are drawn over all pairs and all of the
/// last surface, some where lamps are known to shine through; both are weighed by the sum of their
/// densities (balance heuristic, Veach and Guibas 1995).
class GhostCamera final : public Camera {
  public:
    /// in_order: brings the light that no surface reflects, through the same lens; nullptr: ghosts
    /// alone are shown.
    GhostCamera(std::shared_ptr<const Camera> in_order, GhostOptics, GhostRegions);

    [[nodiscard]] CameraSample sample(const FilmPoint& point, const Bands& bands) const override {
        return one_of_all(point, bands);
    }
    void sample_all(std::span<const FilmPoint>, std::span<const Bands>,
                    std::span<CameraSample>) const override;
    [[nodiscard]] const GhostRegions& regions() const { return regions_; }

  private:
    struct Place;
    void add_rays(const Place&, const GhostRegions::Drawn&, m4 lanes, float effort,
                  CameraSample&) const;
    void add_ghosts(const FilmPoint&, const Bands&, CameraSample&) const;

    std::shared_ptr<const Camera> in_order_;
    GhostOptics optics_;
    GhostRegions regions_;
    std::vector<float> chances_, up_to_;  ///< of each pair; and the sum of those up to it
    LensIndices<f4> line_d_;
};

}  // namespace petzval
