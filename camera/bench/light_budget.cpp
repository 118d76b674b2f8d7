// SPDX-License-Identifier: Apache-2.0
#include "camera/bench/light_budget.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

#include "camera/bench/analysis.h"
#include "camera/bench/light_walk.h"
#include "camera/bench/spot.h"
#include "camera/lens/profile.h"

namespace petzval::camera {
namespace {

// Sag of a surface at its rim, mm; 0 where its shape does not reach so far.
double rim_sag_mm(const Lens& lens, int i) {
    const LensSurface& s = lens.prescription().surfaces[size_t(i)];
    const double sag = sag_mm(s, s.semi_diameter_mm, Section::Y);
    return std::isfinite(sag) ? sag : 0;
}

// Rays of a distant point that are even across the light, on a line or in a square about the first
// surface.
class FrontRays {
  public:
    FrontRays(const Lens& lens, const DistantLight& light)
        : x_(light.section == Section::X),
          bulges_(lens.prescription().surfaces[0].curvature_1_mm > 0),
          last_(lens.last()) {
        const double angle = light.field_deg * std::numbers::pi / 180;
        const double semi = lens.prescription().surfaces[0].semi_diameter_mm;
        const double sag = rim_sag_mm(lens, 0);
        reach_mm_ = std::hypot(semi, sag);
        direction_ = turned(0, std::sin(angle), std::cos(angle));
        across_ = turned(1, 0, 0);
        along_ = turned(0, std::cos(angle), -std::sin(angle));
        middle_ = V3d(0, 0, sag / 2) - direction_ * (2 * reach_mm_);
    }
    /// u, v: -1 to 1, v along the section.
    [[nodiscard]] LightRay at(double u, double v) const {
        return {middle_ + (across_ * u + along_ * v) * reach_mm_, direction_};
    }
    /// side x side rays, those that meet the first surface; all the light is 1. Where few of them
    /// reach the film in order, their cells have more rays each.
    [[nodiscard]] std::vector<LightRay> grid(const LightWalk& walk, int side) const {
        constexpr double wanted = 100;
        constexpr int most = 8;
        const auto middle = [](int i, int of) { return (2 * i + 1.) / of - 1; };
        std::vector<std::array<int, 2>> cells;
        int in_order = 0;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const LightRay ray = at(middle(i, side), middle(j, side));
                if (!meets(walk, ray)) continue;
                cells.push_back({i, j});
                in_order += passes(walk, ray);
            }
        const int finer = std::min(most, int(std::ceil(std::sqrt(wanted / std::max(in_order, 1)))));
        std::vector<LightRay> out;
        for (const auto& [i, j] : cells) {
            std::vector<LightRay> fine;
            bool any = false;
            for (int k = 0; k < finer * finer; ++k) {
                fine.push_back(at(middle(i * finer + k / finer, side * finer),
                                  middle(j * finer + k % finer, side * finer)));
                any |= finer > 1 && passes(walk, fine.back());
            }
            std::erase_if(fine, [&](const LightRay& ray) { return !meets(walk, ray); });
            if (!any) fine = {at(middle(i, side), middle(j, side))};
            for (LightRay& ray : fine) ray.share = 1. / double(cells.size() * fine.size());
            out.insert(out.end(), fine.begin(), fine.end());
        }
        return out;
    }

  private:
    [[nodiscard]] bool meets(const LightWalk& walk, const LightRay& ray) const {
        const LightMeeting met = walk.meet(ray);
        // Its normal lies along what the reflection changes: not of light from behind.
        return !(met.stopped > 0) && direction_.dot(direction_ - met.reflected.direction) > 0 &&
               (bulges_ || direction_.z > 0);
    }
    [[nodiscard]] bool passes(const LightWalk& walk, LightRay ray) const {
        while (ray.share > 0 && ray.next <= last_) ray = walk.meet(ray).passed;
        return ray.share > 0;
    }
    [[nodiscard]] V3d turned(double x, double y, double z) const {
        return x_ ? V3d(y, x, z) : V3d(x, y, z);
    }
    bool x_, bulges_;
    int last_;
    double reach_mm_;
    V3d direction_, across_, along_, middle_;
};

// Where light behind the lens meets the film, as far as it does.
std::optional<BundleRay> on_film(const LightRay& ray, const DistantLight& light) {
    const double sx = ray.direction.x / ray.direction.z, sy = ray.direction.y / ray.direction.z;
    const double dz = light.film_mm - ray.origin_mm.z;
    const BundleRay out{{}, {}, {ray.origin_mm.x + sx * dz, ray.origin_mm.y + sy * dz}, {sx, sy}};
    if (!(std::hypot(out.film_mm[0], out.film_mm[1]) <= light.film_radius_mm)) return std::nullopt;
    return out;
}

}  // namespace

double lit_radius_mm(const Lens& lens) {
    const FieldAndCircle field = field_and_circle(lens);
    const double circle_mm =
        std::max(field.circle_of_half_field_mm.value_or(0), field.image_circle_mm.value_or(0));
    return circle_mm > 0 ? 1.1 * circle_mm / 2 : INFINITY;
}

std::optional<LightBudget> light_budget(const Lens& lens, const LensCoats& coats,
                                        const DistantLight& light, int side) {
    LightWalk walk(lens, coats, light.nm);
    const auto rays = FrontRays(lens, light).grid(walk, side);
    if (rays.empty()) return std::nullopt;
    LightBudget out;
    const auto part = [&](const LightEnd& end) -> double& {
        if (end.fate == LightFate::Absorbed) return out.absorbed;
        if (end.fate == LightFate::BeforeLens) return out.returned;
        if (end.fate == LightFate::Stopped || !on_film(end.ray, light)) return out.stopped;
        return end.ray.reflections == 0   ? out.in_order
               : end.ray.reflections == 2 ? out.two
                                          : out.more;
    };
    for (const LightRay& ray : rays)
        walk.follow(ray, [&](const LightEnd& end) { part(end) += end.ray.share; });
    return out;
}

std::optional<double> transmittance(const Lens& lens, const LensCoats& coats,
                                    const AimedBundle& bundle, double film_mm, int side) {
    const LightWalk walk(lens, coats, bundle.nm());
    double sum = 0;
    int passed = 0;
    for (const BundleRay& on : bundle.trace(bundle.grid(side), film_mm)) {
        const AimedBundle::Line line = bundle.line(on.pupil_point);
        LightRay ray{line.origin_mm, line.direction};
        while (ray.share > 0 && ray.next <= lens.last()) ray = walk.meet(ray).passed;
        sum += ray.share;
        ++passed;
    }
    if (passed == 0) return std::nullopt;
    return sum / passed;
}

std::vector<Ghost> ghosts(const Lens& lens, const LensCoats& coats, const DistantLight& light,
                          int side) {
    constexpr double kLeastRadius_mm = 0.01;
    LightWalk walk(lens, coats, light.nm);
    double in_order = 0;
    std::map<std::array<int, 2>, std::pair<double, std::vector<BundleRay>>> found;
    const auto end = [&](const LightEnd& at) {
        if (at.fate != LightFate::BehindLens) return;
        const auto film = on_film(at.ray, light);
        if (!film) return;
        if (at.ray.reflections == 0) in_order += at.ray.share;
        if (at.ray.reflections != 2) return;
        auto& [share, rays] = found[at.ray.mirrors];
        share += at.ray.share;
        rays.push_back(*film);
    };
    for (const LightRay& ray : FrontRays(lens, light).grid(walk, side))
        walk.follow(ray, end, false);
    std::vector<Ghost> out;
    if (!(in_order > 0)) return out;
    for (const auto& [mirrors, ghost] : found) {
        Ghost g{mirrors[0], mirrors[1]};
        g.light = ghost.first / in_order;
        g.radius_mm = spot_size(ghost.second).rms_mm;
        g.focus_mm = best_shift_mm(ghost.second);
        const double radius2 = std::pow(std::max(g.radius_mm, kLeastRadius_mm), 2);
        // An even disc's mean square radius is half the square of its rim's.
        g.per_mm2 = g.light / (2 * std::numbers::pi * radius2);
        out.push_back(g);
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Ghost& a, const Ghost& b) { return a.per_mm2 > b.per_mm2; });
    return out;
}

std::optional<std::pair<int, double>> worst_surface(const std::vector<Ghost>& ghosts) {
    std::map<int, double> light;
    double all = 0;
    for (const Ghost& g : ghosts) {
        light[g.first] += g.light, light[g.second] += g.light;
        all += g.light;
    }
    const auto worst = std::max_element(light.begin(), light.end(),
                                        [](auto& a, auto& b) { return a.second < b.second; });
    if (!(all > 0)) return std::nullopt;
    return std::pair(worst->first, worst->second / all);
}

std::vector<std::vector<std::array<double, 2>>> ghost_paths(const Lens& lens,
                                                            const LensCoats& coats,
                                                            const DistantLight& light,
                                                            const Ghost& ghost, int count) {
    constexpr int tried = 1000;
    const LightWalk walk(lens, coats, light.nm);
    const FrontRays rays(lens, light);
    const auto drawn = [&](const V3d& p) {
        return std::array{p.z, light.section == Section::X ? p.x : p.y};
    };
    std::vector<std::vector<std::array<double, 2>>> all, out;
    for (int i = 0; i < tried; ++i) {
        LightRay ray = rays.at(0, (2 * i + 1.) / tried - 1);
        std::vector<std::array<double, 2>> path{drawn(ray.origin_mm)};
        while (ray.share > 0 && ray.next >= 0 && ray.next <= lens.last()) {
            const LightMeeting met = walk.meet(ray);
            path.push_back(drawn(met.point_mm));
            const int mirror = ray.reflections == 0   ? ghost.first
                               : ray.reflections == 1 ? ghost.second
                                                      : -1;
            ray = ray.next == mirror ? met.reflected : met.passed;
        }
        if (!(ray.share > 0) || ray.next <= lens.last() || !(ray.direction.z > 0)) continue;
        const auto film = on_film(ray, light);
        if (!film) continue;
        path.push_back(drawn({film->film_mm[0], film->film_mm[1], light.film_mm}));
        all.push_back(std::move(path));
    }
    for (int i = 0; i < count && !all.empty(); ++i)
        out.push_back(all[all.size() * (2 * size_t(i) + 1) / (2 * size_t(count))]);
    return out;
}

std::optional<double> veiling_glare(const Lens& lens, const LensCoats& coats, double film_mm,
                                    int side) {
    const double semi = lens.prescription().surfaces.back().semi_diameter_mm;
    const double rim_mm = lens.vertex_mm(lens.last()) + rim_sag_mm(lens, lens.last());
    const double widest = semi / std::hypot(semi, std::max(film_mm - rim_mm, 0.));
    double in_order = 0, glare = 0;
    const auto end = [&](const LightEnd& at) {
        if (at.fate == LightFate::BeforeLens)
            (at.ray.reflections == 0 ? in_order : glare) += at.ray.share;
    };
    for (const double nm : {450., 550., 650.}) {
        LightWalk walk(lens, coats, nm);
        std::vector<LightRay> rays;
        // Equal cells of direction cosines are equal projected solid angles.
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const double l = widest * ((2 * i + 1.) / side - 1),
                             m = widest * ((2 * j + 1.) / side - 1), n2 = 1 - l * l - m * m;
                if (!(n2 > 0)) continue;
                const LightRay ray{
                    {0, 0, film_mm}, {l, m, -std::sqrt(n2)}, Towards::Scene, lens.last()};
                if (!(walk.meet(ray).stopped > 0)) rays.push_back(ray);
            }
        for (LightRay& ray : rays) {
            ray.share = 1. / double(rays.size());
            walk.follow(ray, end);
        }
    }
    if (!(in_order > 0)) return std::nullopt;
    return glare / (in_order + glare);
}

}  // namespace petzval::camera
