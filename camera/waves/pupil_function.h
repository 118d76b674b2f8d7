// SPDX-License-Identifier: Apache-2.0
// Pupil function: amplitude and phase of the wave that a lens sends to an image point.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "camera/waves/reference_sphere.h"

namespace petzval::camera {

/// Grid of side x side cells over the pupil, in optical direction cosines.
struct PupilGrid {
    std::array<double, 2> first{};  ///< p, q of the middle of cell (0, 0)
    double step = 0;
    int side = 0;
    /// Cells across that the wave needs, so that neighbours differ by less than half a wavelength;
    /// with fewer there are figures of the wave, and no image.
    double needed = 0;

    [[nodiscard]] bool resolves() const { return side >= needed; }
    /// Grid of other cells over the same square.
    [[nodiscard]] PupilGrid with_side(int cells) const;
};
/// Sides of grids for figures of the wave alone, and for images.
inline constexpr int kFiguresPupilSide = 128, kImagePupilSide = 256, kMostPupilSide = 1024;

/// Wave in the exit pupil as seen from an image point. Cells row by row, p first.
///
/// The light on the film about the image point is |U|^2, U(x, y) = integral of amplitude exp(2 pi
/// i (-opd + p x + q y) / wavelength) dp dq / wavelength: Debye's integral, in which |amplitude|^2
/// dp dq is the light of the rays. So its energy and its middle are those of the rays, at any
/// aperture and field. Born and Wolf 1999, Principles of Optics, sec. 8.8; scalar.
struct PupilFunction {
    double nm;
    ReferenceSphere sphere;
    PupilGrid grid;
    std::vector<double> amplitude{};            ///< mean over the cell; 0 beyond rims and iris
    std::vector<double> light{};                ///< of the cell's rays, per unit of p q
    std::vector<double> opd_mm{};               ///< as ReferenceRay has it
    std::vector<std::array<double, 2>> stop{};  ///< x, y in radii of the stop

    [[nodiscard]] double wavelength_mm() const { return nm * 1e-6; }
    [[nodiscard]] std::array<double, 2> cosines(size_t cell) const {
        const auto side = static_cast<size_t>(grid.side);
        return {grid.first[0] + grid.step * static_cast<double>(cell % side),
                grid.first[1] + grid.step * static_cast<double>(cell / side)};
    }
};

/// Share of the light that an iris lets through at a point of the stop, x and y in mm.
using StopTransmission = std::function<double(double, double)>;

/// Grid that holds the wave, of a power of 2 of cells across: as many as images need, from
/// kImagePupilSide to kMostPupilSide. depth_mm: how far from the film images are wanted too.
/// Nothing where no light arrives, or rays arrive parallel.
[[nodiscard]] std::optional<PupilGrid> pupil_grid(const AimedBundle&, const ReferenceSphere&,
                                                  double depth_mm = 0);

/// Pupil function on a grid. Each cell's ray is found by Newton's method with the trace's own
/// derivatives. Edges of rims count by the share of a cell that they leave. The stop's rim is one
/// of them, so that an iris must not reach beyond it.
[[nodiscard]] PupilFunction pupil_function(const AimedBundle&, const ReferenceSphere&,
                                           const PupilGrid&, const StopTransmission& iris = {});

/// The same wave for a film that lies this far behind, about the image point that follows the
/// middle of the light.
[[nodiscard]] PupilFunction moved(PupilFunction, double shift_mm);

}  // namespace petzval::camera
