// SPDX-License-Identifier: Apache-2.0
// Direction cosines at the stop: the coordinates of the film in which diffraction is the same
// everywhere.
#pragma once

#include <optional>

#include "camera/targets/stop_camera.h"

namespace petzval::camera {

/// Optical direction cosines, x and y in the axes of the stop, of the ray that passes the middle of
/// the stop on its way from a film point. Light that is aimed at one point and diffracted to
/// another changes its phase along the stop by the difference of both (Hamilton's characteristic
/// function; Born and Wolf 1999, Principles of Optics, sec. 4.1): a spatial frequency v of the
/// pupil, cycles/mm, is wavelength * v in cosines.
class StopCosines {
  public:
    /// Line d. Exact for a thin lens; for others a polynomial of degree 5 in the film point, by
    /// least squares over the frame, continued straight beyond it.
    explicit StopCosines(const StopCamera&);

    /// Cosines of a film point, and their area by that of the film there.
    struct At {
        V2f cosines{0.f};
        float per_film = 0;
    };
    [[nodiscard]] At at(V2f film) const;
    /// Cosines' derivatives by the film point in the middle of the frame: right, down.
    [[nodiscard]] std::array<V2f, 2> by_film() const {
        return {terms_[0] * index_, terms_[1] * index_};
    }
    /// Film point of cosines; nothing where it lies more than half a frame beyond the edges.
    [[nodiscard]] std::optional<V2f> film_of(V2f cosines) const;

  private:
    static constexpr size_t kTerms = 12;
    /// Slopes at the stop, and their derivatives by the film point.
    struct Slopes {
        V2f slope, by_right, by_down;
    };
    [[nodiscard]] Slopes slopes(V2f from_middle) const;

    std::array<V2f, kTerms> terms_;  ///< of odd powers of the place from the frame's middle
    float index_ = 1;                ///< of the medium about the stop
};

}  // namespace petzval::camera
