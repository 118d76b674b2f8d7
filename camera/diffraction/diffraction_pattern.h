// SPDX-License-Identifier: Apache-2.0
// Far-field diffraction pattern of a pupil, as a density that can be drawn from.
#pragma once

#include <memory>

#include "camera/diffraction/edge_runs.h"
#include "camera/diffraction/pupil.h"
#include "core/sampling/distribution.h"

namespace petzval::camera {

/// Share of the light by spatial frequency v of the pupil, cycles/mm: |F(v)|^2 over the pupil's
/// area, F the Fourier transform of its amplitude (Fraunhofer; Born and Wolf 1999, Principles of
/// Optics, sec. 8.3). Its integral is 1. Near the middle it is a table of a fast Fourier transform,
/// in cells of an eighth of the finest fringe; farther out fringes are averaged (FarPattern).
class DiffractionPattern {
  public:
    /// Of a pupil that lets light through.
    explicit DiffractionPattern(const DiffractingPupil&);

    /// Frequency drawn by the density: u in [0, 1)^2 and pick in [0, 1).
    [[nodiscard]] V2f draw(float pick, V2f u) const {
        if (pick < far_share_) return far_.draw(pick / far_share_, u);
        const Piecewise2D::Draw cell = near_.sample(u);
        return {(float(cell.column) + cell.offset.x) * step_ - half_,
                (float(cell.row) + cell.offset.y) * step_ - half_};
    }
    [[nodiscard]] float density(V2f v) const;
    /// Share of the light beyond the table, and where it goes.
    [[nodiscard]] float far_share() const { return far_share_; }
    [[nodiscard]] const FarPattern& far() const { return far_; }

  private:
    Piecewise2D near_;
    FarPattern far_;
    float step_ = 1, half_ = 1, far_share_ = 0, near_density_ = 0;
};

}  // namespace petzval::camera
