// SPDX-License-Identifier: Apache-2.0
// Glass behind glass, and glass in glass.
#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "tests/stability/sweeps.h"
#include "tests/stability/world.h"

namespace petzval::stability {
namespace {

Ray along_z(const Sampler& sampler) {
    const V2f u = sampler.get2(Dim::Film);
    Ray ray;
    ray.origin = {0.1f * (u.x - 0.5f), 0.1f * (u.y - 0.5f), 10.f};
    ray.direction = {0, 0, -1};
    return ray;
}

// Panes of glass across the z axis in a white sky: 1 comes through or back.
World panes(int count) {
    World world;
    const Material glass = clear_glass(1.5f);
    for (int i = 0; i < count; ++i) {
        const float z = -0.1f * static_cast<float>(i);
        world.place(quad(V3f(-9, -9, z), V3f(18, 0, 0), V3f(0, 18, 0)), glass);
        world.place(quad(V3f(-9, -9, z - 0.05f), V3f(0, 18, 0), V3f(18, 0, 0)), glass);
    }
    world.scene.sky = Sky::uniform(Rgb(1.f));
    world.finish();
    return world;
}

// Share of the light that the end of paths in clear glass cuts off.
double lost(const World& world, int max_specular_depth) {
    integrator::PathOptions options;
    options.max_specular_depth = max_specular_depth;
    return 1 - measure(world, options, 1u << 13, along_z).mean;
}

// What comes from a lamp of 1 nit in the outer of two slabs, behind the inner one.
double from_lamp_in_slabs(double a, bool closed) {
    World world;
    const Material m = clear_glass(1.f, static_cast<float>(a));
    for (const auto& [front, back, half] :
         {std::tuple{0.f, -3.f, 9.f}, std::tuple{-1.f, -2.f, 8.f}}) {
        if (closed) {
            world.place(box(V3f(-half, -half, back), V3f(half, half, front)), m);
            continue;
        }
        world.place(quad(V3f(-9, -9, front), V3f(18, 0, 0), V3f(0, 18, 0)), m);
        world.place(quad(V3f(-9, -9, back), V3f(0, 18, 0), V3f(18, 0, 0)), m);
    }
    world.place(quad(V3f(-5, -5, -2.5f), V3f(10, 0, 0), V3f(0, 10, 0)), glowing(1));
    world.finish();
    integrator::PathOptions options;
    options.roulette_depth = options.max_specular_depth;
    return measure(world, options, 256, along_z).mean;
}

// What comes from a lamp of 1 nit behind a slab of glass and one of water, the gap between them.
double through_glass_and_water(double gap_m) {
    World world;
    const auto gap = static_cast<float>(gap_m);
    world.place(box(V3f(-9, -9, -1), V3f(9, 9, 0)), clear_glass(1.5f));
    world.place(box(V3f(-8, -8, -3), V3f(8, 8, -1 - gap)), clear_glass(1.33f));
    world.place(quad(V3f(-7, -7, -4), V3f(14, 0, 0), V3f(0, 14, 0)), glowing(1));
    world.finish();
    return measure(world, integrator::PathOptions(), 1u << 16, along_z).mean;
}

// Share of light across a stack of media, what goes to and fro included: Fresnel's equations at
// normal incidence; the reflectances of two parts of a stack add up as a geometric series.
double share_through(std::initializer_list<double> indices) {
    double reflected = 0, before = *indices.begin();
    for (const double index : indices) {
        const double root = (index - before) / (index + before), r = root * root;
        const double through = (1 - reflected) * (1 - r) / (1 - reflected * r);
        reflected = 1 - through;
        before = index;
    }
    return 1 - reflected;
}

}  // namespace

Finding chains_of_glass() {
    Finding f{.method = "Chains of glass", .fails = "bias"};
    f.sweep =
        "A ray onto N clear panes (n = 1.5) in a white sky, 8192 samples: what of 1 is lost "
        "because paths end at --method max-clear-depth, 256 unless it is given.";
    f.table.columns = {"panes", "lost at depth 16", "lost at depth 64", "lost at depth 256"};
    const int usual = integrator::PathOptions().max_specular_depth;
    for (const int count : {1, 2, 4, 8, 16, 32, 64, 128}) {
        const World world = panes(count);
        add_row(f, std::to_string(count), percent(lost(world, 16)), percent(lost(world, 64)),
                percent(lost(world, usual)));
    }
    const auto first = [](auto fails) {
        int count = 8;
        while (count < 1024 && !fails(panes(count))) count += std::max(1, count / 16);
        return count;
    };
    f.where = fmt::format(
        "At the usual depth of {} 0.1 % is lost from {} panes on and 1 % from {}: a pane takes "
        "two scatterings and more. Russian roulette ends no path in clear glass",
        usual, first([&](const World& w) { return lost(w, usual) > 0.001; }),
        first([&](const World& w) { return lost(w, usual) > 0.01; }));
    f.instead =
        "A path that is at its depth ends, dark, and `--stats` counts it. `--method "
        "max-clear-depth` "
        "raises it.";
    return f;
}

Finding nested_volumes() {
    Finding f{.method = "Volumes in volumes", .fails = "bias"};
    f.sweep =
        "A slab of 3 m keeps a share a of light for each metre. In its middle stands a slab of 1 m "
        "of the same kind, and 0.5 m behind that, in the outer slab, a lamp of 1 nit (n = 1, so "
        "that nothing bends or reflects): what arrives from it. Both slabs are closed boxes, or "
        "open: a front and a back without sides. Then a slab of glass (n = 1.5) before one of "
        "water (n = 1.33), which overlap, touch, or leave a gap of air: what arrives from a lamp "
        "behind them, and what should where they touch.";
    f.table.columns = {"slabs", "a", "gap (m)", "seen", "should", "ratio"};
    double worst_closed = 0, worst_open = 1, least_through = 1;
    for (const bool closed : {true, false})
        for (const double a : {0.9, 0.5, 0.1, 0.01}) {
            const double seen = from_lamp_in_slabs(a, closed), due = std::pow(a, 2.5);
            add_row(f, closed ? "closed" : "open", a, "", seen, due, seen / due);
            if (closed)
                worst_closed = std::fmax(worst_closed, std::fabs(seen / due - 1));
            else
                worst_open = std::fmax(worst_open, seen / due);
        }
    const double due = share_through({1, 1.5, 1.33, 1});
    for (const double gap_m : {-1e-3, 0., 1e-4, 1e-2}) {
        const double seen = through_glass_and_water(gap_m);
        add_row(f, "glass and water", "", gap_m, seen, due, seen / due);
        least_through = std::fmin(least_through, seen / due);
    }
    constexpr double kAsPrinted = 1e-5;
    f.where = fmt::format(
        "Closed volumes: within {}. Of open ones only the last is remembered: {} times too bright "
        "at a = 0.01 for half a metre. A gap between glass and water is one of air, which takes "
        "{} of the light away",
        percent(std::fmax(worst_closed, kAsPrinted)), number(worst_open),
        percent(1 - least_through));
    f.instead =
        "A path counts the closed volumes that it is in, and the smallest of them is there. `info` "
        "and `render` name glass that is not closed.";
    return f;
}

}  // namespace petzval::stability
