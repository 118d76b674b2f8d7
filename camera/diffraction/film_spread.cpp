// SPDX-License-Identifier: Apache-2.0
#include "camera/diffraction/film_spread.h"

#include <algorithm>

namespace petzval {
namespace {

/// Nodes across the frame, each way: cat's eyes change slowly.
constexpr int kNodes = 5;
/// Points across the iris at which rims are tried.
constexpr int kRimPoints = 96;
constexpr float kNm_mm = 1e-6f;

struct NodeOptics {
    bool sees = false;
    V2f by_x{0.f}, by_y{0.f};
    RimTest passes{};  ///< empty: all pass
};

/// A pencil through a stop without rims. With t the slope of the ray through the middle, direction
/// cosines change with the stop's x by (I - d d^T) / distance, d = t cos: a frequency v of the stop
/// is a slope of wavelength * sqrt(1 + t^2) (v + t (t v)).
template <class PencilOf>
NodeOptics of_pencil(const PencilOf& pencil, V2f film) {
    const V2f t(pencil(film).tangents);
    const V2f across(pencil(film + V2f(0.5f, 0)).tangents - pencil(film - V2f(0.5f, 0)).tangents),
        down(pencil(film + V2f(0, 0.5f)).tangents - pencil(film - V2f(0, 0.5f)).tangents);
    const float scale = kNm_mm * std::sqrt(1 + t.length2());
    const auto on_film = [&](V2f v) {
        const V2f slope = (v + t * t.dot(v)) * scale;
        return V2f(slope.x / across.x, slope.y / down.y);
    };
    return {true, on_film({1, 0}), on_film({0, 1}), {}};
}

NodeOptics optics_at(const ThinLensCamera& camera, V2f film) {
    return of_pencil([&](V2f at) { return camera.pencil(at); }, film);
}
NodeOptics optics_at(const AberratedLensCamera& camera, V2f film) {
    return of_pencil([&](V2f at) { return camera.pencil(at, double(kMiddle_nm)); }, film);
}

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

// Direction cosines at the film by the stop's x and y: least squares over what passes.
NodeOptics optics_at(const LensCamera& camera, V2f film) {
    const Iris& iris = camera.input().iris;
    auto lattice = std::make_shared<RimLattice>(double(iris.bounding_radius_mm()));
    const Lens& lens = *camera.input().lens;
    LeadPoints points;
    points.film_mm.fill(camera.film_mm(film));
    points.nm = splat8(kMiddle_nm);
    const LensIndices<f8> indices = lens.indices(points.nm);
    double n = 0;
    V2d middle(0.), cosines(0.);
    std::array<double, 3> of_stop{};
    std::array<double, 4> mixed{};
    std::vector<std::pair<V2d, V2d>> rays;
    for (size_t k = 0; k < size_t{kRimPoints} * kRimPoints; k += 8) {
        PlanePoint<f8> stop(f8{}, f8{});
        for (size_t i = 0; i < 8; ++i) {
            const V2f at = lattice->point_mm(k + i);
            stop.x[int(i)] = at.x, stop.y[int(i)] = at.y;
        }
        LeadRays found = camera.optics().aim(points, stop, indices);
        found.open = splat8(1), found.density = splat8(1);
        camera.optics().trace(points, indices, found);
        for (int i = 0; i < 8; ++i) {
            const bool open = iris.transmits(stop[i]) > 0;
            const bool passes = found.passed[i] != 0;
            lattice->set(k + size_t(i), passes || !open);
            if (!passes || !open) continue;
            rays.emplace_back(V2d(stop[i]), V2d(found.aimed.l[i], found.aimed.m[i]));
            middle += rays.back().first, cosines += rays.back().second, ++n;
        }
    }
    if (n < 3) return {};
    middle /= n, cosines /= n;
    for (const auto& [at, c] : rays) {
        const V2d s = at - middle, d = c - cosines;
        of_stop[0] += s.x * s.x, of_stop[1] += s.x * s.y, of_stop[2] += s.y * s.y;
        mixed[0] += d.x * s.x, mixed[1] += d.x * s.y, mixed[2] += d.y * s.x, mixed[3] += d.y * s.y;
    }
    const double det = of_stop[0] * of_stop[2] - of_stop[1] * of_stop[1];
    const auto solved = [&](double x, double y) {
        return V2d((x * of_stop[2] - y * of_stop[1]) / det,
                   (y * of_stop[0] - x * of_stop[1]) / det);
    };
    const V2d l = solved(mixed[0], mixed[1]), m = solved(mixed[2], mixed[3]);
    // v of the stop is J^-T v of the cosines, and a cosine's frequency is a length on the film.
    const double j = l.x * m.y - l.y * m.x;
    if (!(det > 0) || j == 0) return {};
    const auto on_film = [&](double x, double y) {
        const V2f mm(float((m.y * x - m.x * y) / j), float((l.x * y - l.y * x) / j));
        return (camera.film_of(mm) - camera.film_of(V2f(0.f))) * kNm_mm;
    };
    NodeOptics out{true, on_film(1, 0), on_film(0, 1), {}};
    if (!lattice->all()) out.passes = [lattice](V2f at) { return (*lattice)(at); };
    return out;
}

NodeOptics optics_at(const StopCamera& camera, V2f film) {
    return std::visit([&](const auto& c) { return optics_at(*c, film); }, camera);
}

}  // namespace

FilmSpread::FilmSpread(const StopCamera& camera) : cosines_(camera) {
    const Iris& iris = iris_of(camera);
    patterns_.push_back(std::make_shared<const DiffractionPattern>(diffracting_pupil(iris)));
    for (int k = 0; k < kNodes * kNodes; ++k) {
        const NodeOptics here =
            optics_at(camera, {float(k % kNodes) / (kNodes - 1), float(k / kNodes) / (kNodes - 1)});
        const DiffractionPattern*& node = nodes_.emplace_back(nullptr);
        if (!here.sees) continue;
        node = patterns_.front().get();
        if (!here.passes) continue;
        const DiffractingPupil pupil = diffracting_pupil(iris, here.passes);
        if (pupil.is_whole) continue;
        node = nullptr;
        if (!(pupil.area_mm2 > 0)) continue;
        patterns_.push_back(std::make_shared<const DiffractionPattern>(pupil));
        node = patterns_.back().get();
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

size_t FilmSpread::memory_bytes() const {
    size_t bytes = 0;
    for (const auto& pattern : patterns_) bytes += pattern->memory_bytes();
    return bytes;
}

double finest_contrast(const StopCamera& camera, V2i frame_px) {
    const NodeOptics here = optics_at(camera, V2f(0.5f));
    if (!here.sees) return 1;
    const DiffractingPupil pupil = diffracting_pupil(iris_of(camera), here.passes);
    // A grating of f cycles over the frame is one of the pupil's points that lie f times the
    // transposed displacement apart.
    const auto kept = [&](V2d cycles) {
        const V2d shift_mm(V2d(here.by_x).dot(cycles), V2d(here.by_y).dot(cycles));
        return contrast(pupil, shift_mm * double(kMiddle_nm));
    };
    return std::min(kept({frame_px.x / 2., 0}), kept({0, frame_px.y / 2.}));
}

}  // namespace petzval
