// SPDX-License-Identifier: Apache-2.0
// Glass behind glass, and glass in glass.
#include <fmt/format.h>

#include <algorithm>

#include "apps/stability/sweeps.h"
#include "apps/stability/world.h"

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
double lost(const World& world, int max_clear_depth) {
    PathOptions options;
    options.max_clear_depth = max_clear_depth;
    return 1 - measure(world, options, 1u << 13, along_z).mean;
}

}  // namespace

Finding chains_of_glass() {
    Finding f;
    f.id = "chains-of-glass";
    f.method = "Chains of glass";
    f.fails = "bias";
    f.sweep =
        "A ray onto N clear panes (n = 1.5) in a white sky, 8192 samples: what of 1 is lost "
        "because paths end at --max-clear-depth, 256 unless it is given.";
    f.table.columns = {"panes", "lost at depth 16", "lost at depth 64", "lost at depth 256"};
    const int usual = PathOptions().max_clear_depth;
    for (const int count : {1, 2, 4, 8, 16, 32, 64, 128}) {
        const World world = panes(count);
        f.table.rows.push_back(row(std::to_string(count), percent(lost(world, 16)),
                                   percent(lost(world, 64)), percent(lost(world, usual))));
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
        "A path that is at its depth ends, dark, and `--stats` counts it. `--max-clear-depth` "
        "raises it.";
    return f;
}

Finding nested_volumes() {
    Finding f;
    f.id = "nested-volumes";
    f.method = "Volumes in volumes";
    f.fails = "bias";
    f.sweep =
        "A ray through a slab of 3 m that keeps a share a of light for each metre, in whose middle "
        "a slab of 1 m of the same kind stands (n = 1, so that nothing bends or reflects): what "
        "comes through, and what should: both outer metres and the inner one. And what arrives "
        "from a lamp of 1 nit that stands in the outer slab, 0.5 m behind the inner one.";
    f.table.columns = {"a",    "comes through",  "should",       "ratio",
                       "lamp", "lamp should be", "ratio of lamp"};
    double worst = 1;
    const auto seen = [](double a, bool lamp) {
        World world;
        const Material m = clear_glass(1.f, static_cast<float>(a));
        for (const auto& [front, back] : {std::pair{0.f, -3.f}, std::pair{-1.f, -2.f}}) {
            world.place(quad(V3f(-9, -9, front), V3f(18, 0, 0), V3f(0, 18, 0)), m);
            world.place(quad(V3f(-9, -9, back), V3f(0, 18, 0), V3f(18, 0, 0)), m);
        }
        if (lamp) {
            Material bulb;
            bulb.base_color = Rgb(0.f);
            bulb.emissive = Rgb(1.f);
            world.place(quad(V3f(-9, -9, -2.5f), V3f(18, 0, 0), V3f(0, 18, 0)), bulb);
        }
        world.scene.sky = Sky::uniform(Rgb(1.f));
        world.finish();
        PathOptions options;
        options.roulette_depth = options.max_depth;
        return measure(world, options, 256, along_z).mean;
    };
    for (const double a : {0.9, 0.5, 0.1, 0.01}) {
        const double through = seen(a, false), due = std::pow(a, 3);
        const double lamp = seen(a, true), lamp_due = std::pow(a, 2.5);
        f.table.rows.push_back(
            row(a, through, due, through / due, lamp, lamp_due, lamp / lamp_due));
        worst = std::fmax(worst, lamp / lamp_due);
    }
    f.where = fmt::format(
        "The way from the inner slab's back to a lamp in the outer slab is not absorbed: {} times "
        "too bright at a = 0.01 for half a metre. What comes through both is right",
        number(worst));
    f.instead =
        "A path remembers one volume: when it leaves the inner one it is in none, until it meets "
        "the back of the outer one, whose absorption then holds for the whole segment.";
    return f;
}

}  // namespace petzval::stability
