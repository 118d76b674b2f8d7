// SPDX-License-Identifier: Apache-2.0
#include "camera/waves/rays_and_pattern.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "camera/bench/spot.h"
#include "camera/waves/wavefront.h"

namespace petzval::camera {
namespace {

constexpr int kLeastCells = 128, kMostCells = 256;  // across the pupil
constexpr int kMostSteps = 20, kRaySide = 128;
constexpr double kTurns = 2 * std::numbers::pi;

// Transfer function as the product of a pupil with itself, moved by whole cells: the Fourier
// transform of the light that point_spread() has. Goodman 2005, Introduction to Fourier Optics, eq.
// 6-28.
class PupilTransfer {
  public:
    PupilTransfer(const PupilFunction& pupil, bool with_opd)
        : side_(size_t(pupil.grid.side)),
          real_(pupil.amplitude.size()),
          imaginary_(pupil.amplitude.size()) {
        for (size_t cell = 0; cell < real_.size(); ++cell) {
            const double turn = -kTurns * pupil.opd_mm[cell] / pupil.wavelength_mm();
            real_[cell] = pupil.amplitude[cell] * (with_opd ? std::cos(turn) : 1);
            imaginary_[cell] = pupil.amplitude[cell] * (with_opd ? std::sin(turn) : 0);
            light_ += pupil.light[cell];
        }
    }
    // At a frequency of so many cells over the wavelength.
    [[nodiscard]] std::complex<double> at(size_t cells, Section along) const {
        if (cells >= side_) return 0;
        const bool x = along == Section::X;
        const size_t by = x ? cells : cells * side_;
        const size_t rows = x ? side_ : side_ - cells, columns = x ? side_ - cells : side_;
        double real = 0, imaginary = 0;
        for (size_t row = 0; row < rows; ++row)
            for (size_t i = row * side_; i < row * side_ + columns; ++i) {
                real += real_[i + by] * real_[i] + imaginary_[i + by] * imaginary_[i];
                imaginary += imaginary_[i + by] * real_[i] - real_[i + by] * imaginary_[i];
            }
        return std::complex(real, imaginary) / light_;
    }

  private:
    size_t side_;
    std::vector<double> real_, imaginary_;
    double light_ = 0;
};

// Grid over the square of another, whose cells are so wide that frequencies are whole numbers of
// them.
struct MatchedGrid {
    PupilGrid grid;
    int cells_a_step;
};
MatchedGrid matched(const PupilGrid& whole, double wavelength_mm, double step_cycles_per_mm) {
    const double across = whole.step * whole.side, shift = wavelength_mm * step_cycles_per_mm;
    const int cells_a_step = std::max(1, int(std::ceil(kLeastCells * shift / across)));
    PupilGrid grid{.step = shift / cells_a_step, .needed = whole.needed};
    grid.side = int(std::ceil(across / grid.step / 4)) * 4;  // rays come in fours
    for (size_t k = 0; k < 2; ++k)
        grid.first[k] =
            whole.first[k] + (whole.side - 1) * whole.step / 2 - (grid.side - 1) * grid.step / 2;
    return {grid, cells_a_step};
}

// Transfer functions at a frequency, each up to a phase.
struct Images {
    std::complex<double> waves, rays, pattern, both;
};

// One wavelength's share of the image.
struct LineImage {
    std::vector<BundleRay> spot;
    double weight;
    std::array<double, 2> middle_mm;  // of the spot
    PupilTransfer waves, pattern;
    int cells_a_step;

    void add_to(Images& sum, int step, double cycles_per_mm, Section along) const {
        const auto cells = size_t(step * cells_a_step);
        const double turn = -kTurns * cycles_per_mm * middle_mm[along == Section::X ? 0 : 1];
        const auto rays = weight * geometric_transfer(spot, cycles_per_mm, along);
        const auto free = pattern.at(cells, along);
        sum.waves += weight * waves.at(cells, along);
        sum.rays += rays;
        sum.pattern += free * std::polar(weight, turn);
        sum.both += free * rays;
    }
};

std::vector<BundleRay> rays_through(const AimedBundle& bundle, double film_mm,
                                    const StopTransmission& iris) {
    auto rays = bundle.trace(bundle.grid(kRaySide), film_mm);
    if (iris)
        std::erase_if(
            rays, [&](const BundleRay& ray) { return iris(ray.stop_mm[0], ray.stop_mm[1]) < 0.5; });
    return rays;
}

void compare(const std::vector<LineImage>& lines, int step, double cycles_per_mm, Section along,
             RaysAndPattern& out) {
    Images sum;
    for (const LineImage& line : lines) line.add_to(sum, step, cycles_per_mm, along);
    const double by_waves = std::abs(sum.waves), by_both = std::abs(sum.both);
    const auto off = [&](const std::complex<double>& other) {
        return std::fabs(by_waves - std::abs(other));
    };
    out.error_of_rays = std::max(out.error_of_rays, off(sum.rays));
    out.error_of_pattern = std::max(out.error_of_pattern, off(sum.pattern));
    if (off(sum.both) <= out.contrast_error) return;
    out.contrast_error = off(sum.both);
    out.cycles_per_mm = cycles_per_mm;
    out.along = along;
    out.by_waves = by_waves;
    out.by_rays_and_pattern = by_both;
}

}  // namespace

bool sharp_or_wide(double rms_waves, double blur) {
    constexpr double sharp = 0.1, wide = 4;
    return rms_waves < sharp || blur > wide;
}

std::optional<RaysAndPattern> rays_and_pattern(std::span<const AimedBundle> bundles,
                                               std::span<const double> weights, double film_mm,
                                               double most_cycles_per_mm,
                                               const StopTransmission& iris) {
    if (bundles.empty()) return std::nullopt;
    std::vector<std::vector<BundleRay>> spots;
    std::vector<SpotSize> sizes;
    std::array<double, 2> image_mm{};
    for (size_t i = 0; i < bundles.size(); ++i) {
        spots.push_back(rays_through(bundles[i], film_mm, iris));
        if (spots.back().empty()) return std::nullopt;
        sizes.push_back(spot_size(spots.back()));
        for (size_t k = 0; k < 2; ++k) image_mm[k] += weights[i] * sizes.back().centroid_mm[k];
    }
    std::vector<ReferenceSphere> spheres;
    std::vector<PupilGrid> grids;
    double lowest = 0, cutoff = 0;  // frequencies that grids tell, and that images have
    for (const AimedBundle& bundle : bundles) {
        spheres.push_back(reference_sphere(bundle, film_mm, image_mm));
        const auto grid = pupil_grid(bundle, spheres.back());
        if (!grid) return std::nullopt;
        grids.push_back(*grid);
        const double whole = grid->step * grid->side / (bundle.nm() * 1e-6);
        cutoff = std::max(cutoff, whole);
        lowest = std::max(lowest, whole / kMostCells);
    }
    const double most = std::clamp(most_cycles_per_mm, lowest, cutoff);
    const int count = std::min(kMostSteps, int(most / lowest));
    const double step_cycles_per_mm = most / count;

    RaysAndPattern out{.blur = INFINITY};
    std::vector<LineImage> lines;
    for (size_t i = 0; i < bundles.size(); ++i) {
        const auto [grid, cells_a_step] =
            matched(grids[i], bundles[i].nm() * 1e-6, step_cycles_per_mm);
        const PupilFunction pupil = pupil_function(bundles[i], spheres[i], grid, iris);
        const WavefrontFigures figures = wavefront_figures(pupil);
        if (!(figures.rms_mm >= 0)) return std::nullopt;
        const double rms_waves = figures.rms_mm / pupil.wavelength_mm();
        const double blur = 2 * sizes[i].rms_mm / (pupil.wavelength_mm() * figures.fnumber);
        out.rms_waves = std::max(out.rms_waves, rms_waves);
        out.blur = std::min(out.blur, blur);
        out.sharp_or_wide &= sharp_or_wide(rms_waves, blur);
        lines.push_back({std::move(spots[i]), weights[i], sizes[i].centroid_mm,
                         PupilTransfer(pupil, true), PupilTransfer(pupil, false), cells_a_step});
    }
    for (int step = 1; step <= count; ++step)
        for (const Section along : {Section::X, Section::Y})
            compare(lines, step, step * step_cycles_per_mm, along, out);
    return out;
}

std::optional<DiffractionLimits> diffraction_limits(const Lens& lens, double film_mm,
                                                    double distance_mm,
                                                    std::span<const double> fields_deg,
                                                    std::span<const WeighedWavelength> light,
                                                    double most_cycles_per_mm,
                                                    const StopTransmission& iris) {
    std::vector<double> weights;
    for (const WeighedWavelength& line : light) weights.push_back(line.weight);
    std::optional<DiffractionLimits> out;
    for (const double field_deg : fields_deg) {
        std::vector<AimedBundle> bundles;
        for (const WeighedWavelength& line : light)
            if (auto bundle = AimedBundle::aim(
                    lens, {.field_deg = field_deg, .distance_mm = distance_mm}, line.nm))
                bundles.push_back(*std::move(bundle));
        if (bundles.size() < light.size()) continue;
        const auto found = rays_and_pattern(bundles, weights, film_mm, most_cycles_per_mm, iris);
        if (!found) continue;
        if (!out) out.emplace();
        out->sharp_or_wide &= found->sharp_or_wide;
        if (found->contrast_error >= out->worst.contrast_error) {
            out->field_deg = field_deg;
            out->worst = *found;
        }
    }
    return out;
}

}  // namespace petzval::camera
