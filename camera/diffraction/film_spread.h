// SPDX-License-Identifier: Apache-2.0
// Spread of light over the film by diffraction: the pattern of each film point's pupil.
#pragma once

#include <memory>
#include <vector>

#include "camera/diffraction/diffraction_pattern.h"
#include "camera/diffraction/stop_cosines.h"
#include "camera/targets/stop_camera.h"

namespace petzval::camera {

/// Pattern of the light that comes to a point of the film.
struct SpreadHere {
    const DiffractionPattern* pattern = nullptr;  ///< nullptr: no light comes through
    StopCosines::At here;
};

/// Spread of a camera. In cosines at the stop the pattern is the same about each film point, but
/// for what rims leave of the iris: that is known at nodes over the frame, of which one is drawn.
class FilmSpread {
  public:
    /// Patterns of line d, without aberrations: rays have those.
    explicit FilmSpread(const StopCamera&);

    /// Spread of light for a film point; `pick` in [0, 1) draws the pattern and becomes such a
    /// number again.
    [[nodiscard]] SpreadHere at(V2f film, float& pick) const;
    /// Frequency of the pupil, cycles/mm, for light of a wavelength that is aimed at one place, by
    /// its cosines, and comes to another.
    [[nodiscard]] static V2f frequency(V2f from, V2f to, float nm) {
        return (to - from) / (nm * kNm_mm);
    }
    /// Film point that a frequency leads to; nothing where it lies far beyond the frame.
    [[nodiscard]] std::optional<V2f> film_of(V2f from, V2f frequency, float nm) const {
        return cosines_.film_of(from + frequency * (nm * kNm_mm));
    }
    /// Density of frequencies by area of the film at a place, for one of 1.
    [[nodiscard]] static float per_film(const StopCosines::At& at, float nm) {
        return at.per_film / sqr(nm * kNm_mm);
    }
    [[nodiscard]] StopCosines::At cosines(V2f film) const { return cosines_.at(film); }

  private:
    static constexpr float kNm_mm = 1e-6f;

    StopCosines cosines_;
    std::vector<const DiffractionPattern*> nodes_;
    std::vector<std::shared_ptr<const DiffractionPattern>> patterns_;  ///< of the nodes
};

/// Share of contrast that diffraction leaves to the finest grating of a picture in the middle of
/// the frame, two pixels for each of its periods: the lesser of both directions. Line d.
[[nodiscard]] double finest_contrast(const StopCamera&, V2i frame_px);

}  // namespace petzval::camera
