// SPDX-License-Identifier: Apache-2.0
// Observer: draws the wavelengths of a sample, and turns their radiance into RGB and XYZ.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/math/math.h"
#include "core/sampling/distribution.h"
#include "core/spectrum/bands.h"
#include "core/spectrum/bins.h"
#include "core/spectrum/spectrum_table.h"

namespace petzval {

/// Spectra that an observer is made from. Those of lights are power up to a factor, W/nm; not all
/// zero.
struct ObserverInput {
    std::array<SpectrumTable, 3> xyz_bar;   ///< CIE 1931 2 degrees
    std::array<SpectrumTable, 3> response;  ///< of the sensor's three channels, up to a factor
    /// Matrix from the three responses to the film's linear sRGB, by rows. It must carry the scale,
    /// or white light of 1 nit does not give what it is meant to: core/spectrum/sensor_fit.h.
    std::array<V3f, 3> matrix;
    SpectrumTable white;                 ///< light that an RGB of 1 stands for
    std::array<SpectrumTable, 3> basis;  ///< reflectances of R, G and B; they add up to 1
    std::vector<SpectrumTable> lights;   ///< spectra of other lights in the scene
    std::optional<Bins> bins;            ///< half of the wavelengths are drawn evenly from these
};

/// Draws wavelengths in proportion to what light and sensor make of them.
class Observer {
  public:
    /// An observer whose lanes carry linear RGB.
    Observer() = default;
    explicit Observer(const ObserverInput&);

    [[nodiscard]] bool spectral() const { return !rows_.empty(); }
    [[nodiscard]] const std::optional<Bins>& bins() const { return bins_; }

    /// Bands of four wavelengths from one number in [0, 1): its place among the quantiles, and the
    /// three that lie 1/4, 2/4 and 3/4 further on (Wilkie et al. 2014, "Hero Wavelength Spectral
    /// Sampling", section 3.1, in the quantiles instead of the range). The first leads.
    [[nodiscard]] Bands draw(float u) const;
    /// Bands of these wavelengths, kFirst_nm to kLast_nm, that were drawn with these densities
    /// (1/nm); the mean of the estimates of those that are on goes to the film.
    [[nodiscard]] Bands at(f4 nm, f4 pdf, m4 on) const;
    /// Density of a wavelength that draw gives, 1/nm.
    [[nodiscard]] float pdf(float nm) const;
    /// CIE XYZ estimate of one sample, nits; zero unless spectral().
    [[nodiscard]] V3f to_xyz(f4 radiance, const Bands&) const;

  private:
    /// Curves at one nanometre: what Bands holds, side by side for one load.
    struct Row {
        f4 basis_white;  ///< red, green, blue, white
        f4 to_rgb;
        f4 xyz_bar;  ///< times the luminous efficacy
    };
    [[nodiscard]] Row at(float nm) const;  ///< linear between the rows

    std::vector<Row> rows_;  ///< kSpectrumSize, or none
    Piecewise1D density_;    ///< one cell between two nanometres
    std::optional<Bins> bins_;
};

}  // namespace petzval
