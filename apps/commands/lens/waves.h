// SPDX-License-Identifier: Apache-2.0
// Waves of an analysis: the light of its lines through the lens, and what rays alone leave out.
#pragma once

#include "apps/commands/lens/analysis.h"
#include "camera/waves/point_spread.h"
#include "camera/waves/wavefront.h"

namespace petzval::apps {

/// Wavelength of the light and its share.
struct LightLine {
    std::string name;
    double nm, weight;  ///< weights add up to 1
};
/// Adds --light: wavelengths and weights.
void add_light(CLI::App&, AnalysisOptions&);
/// Lines of --light; F, d and C in equal parts where it says nothing. Warns of a wavelength beyond
/// a glass's range.
[[nodiscard]] std::vector<LightLine> light_of(const AnalysisOptions&, const camera::Lens&);

/// Their weights.
[[nodiscard]] std::vector<double> weights_of(const std::vector<LightLine>&);

/// Contrast that rays of each line leave of lines across a section: geometric.
[[nodiscard]] double ray_contrast(const std::vector<std::vector<camera::BundleRay>>&,
                                  const std::vector<LightLine>&, double cycles_per_mm,
                                  camera::Section along);

/// Grid of pupil_grid(). Throws ArgumentError where there is none.
[[nodiscard]] camera::PupilGrid require_grid(const camera::AimedBundle&,
                                             const camera::ReferenceSphere&, double depth_mm = 0);

/// Pupil functions of a field, one for each line, all about the middle of the whole image. Empty
/// where the largest grid is too coarse for the wave. Throws ArgumentError where no light arrives.
/// depth_mm: how far from the film images are wanted too.
[[nodiscard]] std::vector<camera::PupilFunction> field_waves(const FieldSetup&, double field_deg,
                                                             const std::vector<LightLine>&,
                                                             double depth_mm = 0);
/// The same; throws ArgumentError where it would be empty.
[[nodiscard]] std::vector<camera::PupilFunction> require_waves(const FieldSetup&, double field_deg,
                                                               const std::vector<LightLine>&,
                                                               double depth_mm = 0);

/// Contrast of a field's image along a section by waves, as a function of the frequency.
class WaveContrast {
  public:
    WaveContrast(const std::vector<camera::PupilFunction>&, const std::vector<LightLine>&);
    [[nodiscard]] double at(double cycles_per_mm, camera::Section along) const;

  private:
    std::vector<std::array<camera::LineSpread, 2>> lines_;  ///< along x, along y
    std::vector<double> weights_;
};

/// Prints how much sharper spots are by rays alone than by waves, at line d.
void print_wave_spots(const FieldSetup&);
/// Prints the same for the contrast at a frequency. rays: tangential, sagittal, of each field.
void print_wave_contrast(const FieldSetup&, const std::vector<LightLine>&, double cycles_per_mm,
                         const std::vector<std::array<double, 2>>& rays);

}  // namespace petzval::apps
