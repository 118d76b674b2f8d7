// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/film_spread.h"

#include <algorithm>

namespace petzval::camera {
namespace {

/// Nodes across the frame, each way: cat's eyes change slowly.
constexpr int kNodes = 5;
/// Points across the iris at which rims are tried.
constexpr int kRimPoints = 96;
/// Lattice of points of the stop, and which of them light passes.
class RimLattice {
  public:
    explicit RimLattice(double reach_mm)
        : reach_mm_(float(reach_mm)), passes_(size_t{kRimPoints} * kRimPoints) {}
    [[nodiscard]] V2f point_mm(size_t k) const {
        return {place(k % kRimPoints), place(k / kRimPoints)};
    }
    void set(size_t k, bool passes) { passes_[k] = passes; }
    [[nodiscard]] bool all() const {
        return std::ranges::all_of(passes_, [](char p) { return p; });
    }
    [[nodiscard]] bool operator()(V2f at) const {
        return passes_[cell(at.y) * kRimPoints + cell(at.x)];
    }

  private:
    [[nodiscard]] float place(size_t i) const {
        return ((float(i) + 0.5f) * 2 / kRimPoints - 1) * reach_mm_;
    }
    [[nodiscard]] size_t cell(float mm) const {
        const float i = (mm / reach_mm_ + 1) / 2 * kRimPoints;
        return size_t(std::clamp(int(i), 0, kRimPoints - 1));
    }
    float reach_mm_;
    std::vector<char> passes_;
};

/// Which points of the iris light passes on its way to a film point.
RimLattice rims_of(const LensCamera& camera, V2f film) {
    const Iris& iris = camera.input().iris;
    RimLattice out(double(iris.bounding_radius_mm()));
    LeadPoints points;
    points.film_mm.fill(camera.film_mm(film));
    points.nm = splat8(kMiddle_nm);
    const LensIndices<f8> indices = camera.input().lens->indices(points.nm);
    for (size_t k = 0; k < size_t{kRimPoints} * kRimPoints; k += 8) {
        PlanePoint<f8> stop(f8{}, f8{});
        for (size_t i = 0; i < 8; ++i) {
            const V2f at = out.point_mm(k + i);
            stop.x[int(i)] = at.x, stop.y[int(i)] = at.y;
        }
        LeadRays found = camera.optics().aim(points, stop, indices);
        camera.optics().trace(points, indices, found);
        for (int i = 0; i < 8; ++i)
            out.set(k + size_t(i), found.passed[i] != 0 || !(iris.transmits(stop[i]) > 0));
    }
    return out;
}

/// Pattern of a pupil; nullptr where it lets no light through, or too little for its raster.
std::shared_ptr<const DiffractionPattern> pattern_of(const DiffractingPupil& pupil) {
    return pupil.area_mm2 > 0 ? std::make_shared<const DiffractionPattern>(pupil) : nullptr;
}

}  // namespace

FilmSpread::FilmSpread(const StopCamera& camera) : cosines_(camera) {
    const Iris& iris = iris_of(camera);
    patterns_.push_back(pattern_of(diffracting_pupil(iris)));
    nodes_.assign(size_t{kNodes} * kNodes, patterns_.front().get());
    const auto* lens = std::get_if<std::shared_ptr<const LensCamera>>(&camera);
    for (int k = 0; lens && k < kNodes * kNodes; ++k) {
        const V2f film(float(k % kNodes) / (kNodes - 1), float(k / kNodes) / (kNodes - 1));
        const RimLattice rims = rims_of(**lens, film);
        if (rims.all()) continue;
        const DiffractingPupil pupil = diffracting_pupil(iris, rims);
        if (pupil.is_whole) continue;
        patterns_.push_back(pattern_of(pupil));
        nodes_[size_t(k)] = patterns_.back().get();
    }
}

SpreadHere FilmSpread::at(V2f film, float& pick) const {
    size_t drawn = 0;
    for (size_t k = 0; k < 2; ++k) {  // down, then right
        const float place = std::clamp(k == 0 ? film.y : film.x, 0.f, 1.f) * (kNodes - 1);
        const auto below = std::min(size_t(place), size_t(kNodes - 2));
        const float above = place - float(below);
        const bool next = pick < above;
        pick = std::min(next ? pick / above : (pick - above) / (1 - above), kOneMinus);
        drawn = drawn * kNodes + below + next;
    }
    return {nodes_[drawn], cosines_.at(film)};
}

double finest_contrast(const StopCamera& camera, V2i frame_px) {
    DiffractingPupil pupil;
    if (const auto* lens = std::get_if<std::shared_ptr<const LensCamera>>(&camera))
        pupil = diffracting_pupil(iris_of(camera), rims_of(**lens, V2f(0.5f)));
    else
        pupil = diffracting_pupil(iris_of(camera));
    if (!(pupil.area_mm2 > 0)) return 1;
    const auto [right, down] = StopCosines(camera).by_film();
    const double area = double(right.x) * double(down.y) - double(right.y) * double(down.x);
    // A grating of f cycles over the frame is one of two points of the pupil: with c cosines by the
    // film point, they lie wavelength * c^-T f apart.
    const auto kept = [&](V2d f) {
        const V2d apart(double(down.y) * f.x - double(right.y) * f.y,
                        double(right.x) * f.y - double(down.x) * f.x);
        return contrast(pupil, apart * (double(kMiddle_nm) * 1e-6 / area));
    };
    return std::min(kept({frame_px.x / 2., 0}), kept({0, frame_px.y / 2.}));
}

}  // namespace petzval::camera
