// SPDX-License-Identifier: Apache-2.0
// Ghosts pair by pair, drawn from the film, against walks of light from the scene through the lens;
// and how many times as efficient regions are as draws over the pairs and the last surface, which
// know nothing of the lamp. Uncoated, the stop wide open, a sun of 0.53 degrees, line d.
//
//   ghost_pairs LENS DEGREES [DRAWS [WALKS]]
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "camera/bench/light_walk.h"
#include "camera/ghosts/ghost_camera.h"
#include "camera/ghosts/lens_face.h"
#include "tests/support/lens_cameras.h"

namespace petzval {
namespace {

struct PairSums {
    double drawn = 0, drawn2 = 0, walked = 0, walked2 = 0;
};

struct Subject {
    std::shared_ptr<const LensCamera> camera;
    SmallFeature sun;

    Subject(const std::string& lens, double deg) {
        LensCameraInput in = test::input_of(lens, DispersionMode::Shared);
        in.to_world = M44f();
        in.coating = Coating::Uncoated;
        camera = std::make_shared<LensCamera>(std::move(in));
        constexpr double kRadius = 0.53 / 2 * M_PI / 180;
        const double a = deg * M_PI / 180;
        sun = {SmallFeature::Kind::Lamp, V3f(0, float(std::sin(a)), -float(std::cos(a)))};
        sun.at_infinity = true;
        sun.radius_m = sun.reach_m = float(kRadius);
        sun.area_m2 = 2 * M_PI * (1 - std::cos(kRadius));
        sun.radiance = 1;
    }
};

using Pairs = std::map<std::pair<int, int>, PairSums>;

void walk(const Subject& of, uint32_t count, Pairs& pairs) {
    const LensCameraInput& in = of.camera->input();
    const Lens& lens = *in.lens;
    const LensCoats coats(lens, in.coating);
    LightWalk walk(lens, coats, kLineD_nm);
    const double reach = lens.prescription().surfaces[0].semi_diameter_mm;
    const V3d d = -V3d(of.sun.centre);
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Owen, 3, {0, 0, i});
        const V2d at = (V2d(sampler.get2(Dim::Lens)) * 2.0 - V2d(1)) * reach;
        const auto face = at.length() <= reach ? face_point(lens, 0, at) : std::nullopt;
        if (!face || !(d.dot(face->normal) > 0)) continue;
        LightRay ray;
        ray.direction = d;
        ray.origin_mm = face->point_mm - d;
        ray.share = d.dot(face->normal) / face->normal.z * 4 * reach * reach * of.sun.area_m2;
        walk.follow(
            ray,
            [&](const LightEnd& end) {
                if (end.fate != LightFate::BehindLens || end.ray.reflections != 2) return;
                const V3d from = end.ray.origin_mm, way = end.ray.direction;
                const V3d film = from + way * ((in.film_mm - from.z) / way.z);
                if (std::fabs(film.x) > in.film_width_mm / 2 ||
                    std::fabs(film.y) > in.film_height_mm / 2)
                    return;
                PairSums& sums = pairs[{end.ray.mirrors[0], end.ray.mirrors[1]}];
                sums.walked += end.ray.share;
                sums.walked2 += end.ray.share * end.ray.share;
            },
            false);
    }
}

// Mean square of a draw that knows nothing of the lamp, by draws that do: the integral of the
// square over its density.
struct Draws {
    double sum = 0, squares = 0, blind_squares = 0;
};

Draws draw(const Subject& of, uint32_t count, Pairs& pairs) {
    const GhostOptics optics(of.camera);
    const GhostRegions regions(optics, {&of.sun, 1});
    const GhostPupils pupils(optics);
    const LensCameraInput& in = of.camera->input();
    const double film_mm2 = in.film_width_mm * in.film_height_mm;
    const f4 nm = splat(float(kLineD_nm));
    const LensIndices<f4> indices = optics.lens().exact_indices(nm);
    Draws out;
    for (uint32_t i = 0; i < count; ++i) {
        const Sampler sampler(SamplerKind::Owen, 4, {0, 0, i});
        const V2f film = of.camera->film_mm(sampler.get2(Dim::Film));
        const auto at =
            regions.draw(film, 0, sampler.get1(Dim::GhostPick), sampler.get2(Dim::GhostPoint));
        if (!at || at->rear_mm.length() > float(optics.rear_mm())) continue;
        const GhostPair pair = optics.pairs()[at->pair];
        const auto found = optics.ray(pair, film, at->rear_mm, indices, nm, m4{-1, 0, 0, 0});
        if (!found ||
            double(of.camera->in_world(lane_of(found->ray, 0)).direction.dot(of.sun.centre)) <
                std::cos(double(of.sun.reach_m)))
            continue;
        const double light = double(found->share[0] * found->sr_per_mm2),
                     density = double(regions.density(film, 0, *at)), value = light / density,
                     blind = double(pupils.density(film, *at));
        PairSums& sums = pairs[{pair.first, pair.second}];
        sums.drawn += value * film_mm2;
        sums.drawn2 += value * value * film_mm2 * film_mm2;
        out.sum += value;
        out.squares += value * value;
        if (blind > 0) out.blind_squares += light * light / (blind * density);
    }
    return out;
}

int main_of(int count, char** words) {
    if (count < 3) {
        fmt::print(stderr, "ghost_pairs LENS DEGREES [DRAWS [WALKS]]\n");
        return 2;
    }
    const Subject subject(words[1], std::atof(words[2]));
    const auto number = [&](int i, uint32_t other) {
        return count > i ? uint32_t(std::atoi(words[i])) : other;
    };
    const uint32_t draws = number(3, 4'000'000), walks = number(4, 400'000);
    Pairs pairs;
    walk(subject, walks, pairs);
    const Draws drawn = draw(subject, draws, pairs);
    double all = 0, all_drawn = 0, rest = 0, rest_drawn = 0, worst = 0, worst_sigma = 0;
    int large = 0;
    for (const auto& [pair, s] : pairs) all += s.walked / walks;
    for (const auto& [pair, s] : pairs) {
        const double a = s.walked / walks, b = s.drawn / draws;
        all_drawn += b;
        if (a < 1e-3 * all) {
            rest += a, rest_drawn += b;
            continue;
        }
        ++large;
        const double sigma = std::hypot(std::sqrt(s.walked2) / walks, std::sqrt(s.drawn2) / draws);
        worst = std::max(worst, std::fabs(b / a - 1));
        worst_sigma = std::max(worst_sigma, std::fabs(b - a) / sigma);
        fmt::print("  {:2},{:2}  {:7.4f} of the light  {:+6.2f} % +- {:.2f} %\n", pair.first,
                   pair.second, a / all, 100 * (b / a - 1), 100 * sigma / a);
    }
    const double mean = drawn.sum / draws;
    fmt::print(
        "{}: {} pairs above a thousandth, off by {:.2f} % at most, {:.1f} standard errors; the "
        "rest, "
        "{:.4f} of the light, {:+.2f} %; all {:+.2f} %; regions have {:.0f} times the efficiency\n",
        words[1], large, 100 * worst, worst_sigma, rest / all, 100 * (rest_drawn / rest - 1),
        100 * (all_drawn / all - 1),
        (drawn.blind_squares / draws - mean * mean) / (drawn.squares / draws - mean * mean));
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int count, char** words) {
    return petzval::main_of(count, words);
}
