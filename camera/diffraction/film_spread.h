// SPDX-License-Identifier: Apache-2.0
// Spread of light over the film by diffraction: the pattern of each film point's pupil, in places
// of the film.
#pragma once

#include <memory>
#include <vector>

#include "camera/diffraction/diffraction_pattern.h"
#include "camera/targets/stop_camera.h"

namespace petzval {

/// Pattern of the light that is aimed at a point of the film. A frequency v of the pupil,
/// cycles/mm, displaces light of a wavelength by wavelength_nm * (by_x * v.x + by_y * v.y), as
/// FilmPoint counts places.
struct SpreadHere {
    const DiffractionPattern* pattern = nullptr;  ///< nullptr: no light comes through
    V2f by_x{0.f}, by_y{0.f};

    [[nodiscard]] V2f displacement(V2f v, float nm) const { return (by_x * v.x + by_y * v.y) * nm; }
    [[nodiscard]] V2f frequency(V2f displacement, float nm) const {
        return V2f(displacement.x * by_y.y - displacement.y * by_y.x,
                   displacement.y * by_x.x - displacement.x * by_x.y) /
               (determinant() * nm);
    }
    /// Area of the film for a unit of the plane of frequencies.
    [[nodiscard]] float area(float nm) const { return std::fabs(determinant()) * nm * nm; }
    /// Density with which light of a wavelength is displaced so, by area of the film.
    [[nodiscard]] float density(V2f displacement, float nm) const {
        return pattern->density(frequency(displacement, nm)) / area(nm);
    }
    [[nodiscard]] float determinant() const { return by_x.x * by_y.y - by_x.y * by_y.x; }
};

/// Spread of a camera, at nodes over the frame. Between nodes displacements are interpolated, and
/// one of the patterns around is drawn.
class FilmSpread {
  public:
    /// Patterns of line d, without aberrations: rays have those.
    explicit FilmSpread(const StopCamera&);

    /// Spread of light for a film point; `pick` in [0, 1) draws the pattern and becomes such a
    /// number again.
    [[nodiscard]] SpreadHere at(V2f film, float& pick) const;
    [[nodiscard]] size_t memory_bytes() const;

  private:
    std::vector<SpreadHere> nodes_;
    std::vector<std::shared_ptr<const DiffractionPattern>> patterns_;  ///< of the nodes
};

/// Share of contrast that diffraction leaves to the finest grating of a picture in the middle of
/// the frame, two pixels for each of its periods: the lesser of both directions. Line d.
[[nodiscard]] double finest_contrast(const StopCamera&, V2i frame_px);

}  // namespace petzval
