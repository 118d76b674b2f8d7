// SPDX-License-Identifier: Apache-2.0
// Ghosts of a lens from a point of its film: which way their light came, and how much of it
// arrives.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "camera/ghosts/ghost_trace.h"
#include "camera/models/lens_camera.h"

namespace petzval::camera {

/// Ray of a ghost from a point of the film.
struct GhostRay {
    LensRay<f4> ray;  ///< in front of the lens
    f4 share{};       ///< of the light that arrives, by lane: iris, coats, reflections
    /// Projected solid angle at the film, sr, for an area of 1 mm^2 across the axis on the last
    /// surface.
    float sr_per_mm2 = 0;
};

class GhostOptics {
  public:
    /// Ghosts of a camera's lens with its iris, its film and its coating.
    explicit GhostOptics(std::shared_ptr<const LensCamera>);

    [[nodiscard]] const LensCamera& camera() const { return *camera_; }
    [[nodiscard]] const Lens& lens() const { return *camera_->input().lens; }
    /// Pairs that reflect: where the medium changes and the coating is not ideal.
    [[nodiscard]] const std::vector<GhostPair>& pairs() const { return pairs_; }
    /// Radius of the last surface, and its area across the axis.
    [[nodiscard]] double rear_mm() const { return rear_mm_; }
    [[nodiscard]] float rear_mm2() const;
    /// Product of both surfaces' reflectances for light along the axis: mean of the visible.
    [[nodiscard]] float reflects(GhostPair) const;

    /// Ray from a film point through a point beside the axis on the last surface; nothing where
    /// none of the lanes passes. nm: wavelengths at which the coats count.
    [[nodiscard]] std::optional<GhostRay> ray(GhostPair, V2f film_mm, V2f rear_mm,
                                              const LensIndices<f4>&, f4 nm, m4 lanes) const;

  private:
    /// Meeting with a surface on the way from the film.
    struct CoatHit {
        int surface;
        Towards towards;
        bool mirrors;
        f4 cosine, index;
    };
    /// That of the camera's lens; there is one where there are pairs.
    [[nodiscard]] const CoatTables& tables() const { return *camera_->optics().coats(); }
    [[nodiscard]] f4 coat_share(const CoatHit&, const LensIndices<f4>&, f4 nm) const;

    std::shared_ptr<const LensCamera> camera_;
    std::vector<GhostPair> pairs_;
    double rear_mm_;
};

}  // namespace petzval::camera
