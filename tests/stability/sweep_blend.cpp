// SPDX-License-Identifier: Apache-2.0
// Stacks of BLEND cards.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "tests/stability/sweeps.h"
#include "tests/stability/world.h"

namespace petzval::stability {
namespace {

constexpr double kSun_lx = 10, kCard = 0.5, kFloor = 0.8, kCosine = 0.8;

// Lambert's cards, a millimetre apart over a floor, and a sun that shines through them.
World cards(int count, double alpha) {
    World world;
    Material card = diffuse(float(kCard));
    card.alpha_mode = AlphaMode::Blend;
    card.alpha = static_cast<float>(alpha);
    for (int i = 0; i <= count; ++i)
        world.place(quad(V3f(-90, -90, 1e-3f * float(i)), V3f(180, 0, 0), V3f(0, 180, 0)),
                    i == 0 ? diffuse(float(kFloor)) : card);
    world.scene.lights.push_back(SunLight{V3f(0, -0.6f, -0.8f), Rgb(float(kSun_lx))});
    world.finish();
    return world;
}

// What is seen of them by light that is scattered once: a card is lit and seen through those above.
double shown(int count, double alpha) {
    const double left = 1 - double{static_cast<float>(alpha)},
                 lit = kSun_lx * kCosine / std::numbers::pi;
    double sum = kFloor * std::pow(left, 2 * count);
    for (int i = 0; i < count; ++i) sum += kCard * (1 - left) * std::pow(left, 2 * i);
    return lit * sum;
}

// Off the diagonals of the cards.
Ray from_above(const Sampler& sampler) {
    const V2f u = sampler.get2(Dim::Film);
    Ray ray;
    ray.origin = {0.7f + 0.1f * u.x, 0.1f + 0.1f * u.y, 9};
    ray.direction = {0, 0, -1};
    return ray;
}

}  // namespace

Finding stacks_of_cards() {
    Finding f{.method = "Stacks of BLEND cards", .fails = "variance"};
    f.sweep =
        "N cards of one coverage a millimetre apart, which leave half of the light together, over "
        "a "
        "floor; a sun shines through them at 37 degrees, and paths end after one scattering. What "
        "a "
        "ray from above sees, over the closed form; the variance of a sample, relative; the rays "
        "that a sample casts for what it sees, and for the sun. 4096 samples.";
    f.table.columns = {"cards", "coverage", "seen / closed form", "variance", "rays", "to the sun"};
    integrator::PathOptions options;
    options.max_depth = 1;
    double weighed = 0, drawn = 0, most_rays = 0;
    for (const int count : {1, 2, 4, 8, 9, 16, 32, 100, 1000}) {
        const double alpha = 1 - std::pow(0.5, 1. / count);
        const Measured m = measure(cards(count, alpha), options, 1u << 12, from_above);
        add_row(f, std::to_string(count), alpha, m.mean / shown(count, alpha), m.relative_variance,
                m.rays, m.shadow_rays);
        double& worst = count <= int(PassedBlends::kMost) ? weighed : drawn;
        worst = std::max(worst, m.relative_variance);
        most_rays = std::max(most_rays, m.rays + m.shadow_rays);
    }
    f.where = fmt::format(
        "The variance is {} at most up to {} cards and {} beyond: so many are weighed on one ray, "
        "and a shadow ray that passes more meets them all by chance. A sample casts no more than "
        "{} rays",
        number(weighed), PassedBlends::kMost, number(drawn), number(most_rays));
    f.instead =
        "Nothing is said: the picture is right, and noisier. A ray asks every card that it passes, "
        "so that its time grows with their number.";
    return f;
}

}  // namespace petzval::stability
