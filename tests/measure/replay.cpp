// SPDX-License-Identifier: Apache-2.0
// How much of a render is bare traversal: the rays of a render, recorded and traced again with
// nothing around the library's calls. One thread, CPU time, everything in one run.
//
//   replay SCENE [--look-at ...] [--fov ...] [--env ...] [--size ...] [--spp ...] [--traversal ...]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/request/parse.h"
#include "apps/setup/render_setup.h"
#include "core/traversal/embree.h"
#include "integrator/path/path_impl.h"
#include "integrator/render/executor.h"
#include "integrator/render/render.h"
#include "io/base/clock.h"

namespace petzval {
namespace {

struct Recorder {
    const Bvh& bvh;
    mutable std::vector<Ray> nearest, shadow;

    std::optional<Hit> intersect(const Ray& r, const PassedBlends* passed) const {
        nearest.push_back(r);
        return bvh.intersect(r, passed);
    }
    std::optional<Hit> intersect_front(const Ray& r, float t_min,
                                       const PassedBlends* passed) const {
        nearest.push_back(r);
        return bvh.intersect_front(r, t_min, passed);
    }
    Passage passage(const Ray& r) const {
        shadow.push_back(r);
        return bvh.passage(r);
    }
    bool has_cutouts() const { return bvh.has_cutouts(); }
    bool has_blends() const { return bvh.has_blends(); }
    std::vector<Hit> all_hits(const Ray& r) const { return bvh.all_hits(r); }
};

RTCRay bare(const Ray& r) {
    RTCRay ray{};
    ray.org_x = r.origin.x, ray.org_y = r.origin.y, ray.org_z = r.origin.z;
    ray.dir_x = r.direction.x, ray.dir_y = r.direction.y, ray.dir_z = r.direction.z;
    ray.tnear = 1e-30f, ray.tfar = r.t_max, ray.mask = ~0u;
    return ray;
}

// Seconds to trace what was recorded, in the order of the render.
double retrace_s(RTCScene scene, const std::vector<Ray>& nearest, const std::vector<Ray>& shadow) {
    struct {  // as in core/traversal/bvh.cpp: its filter reads the ray
        embree::Context of_embree = embree::new_context();
        const Ray* ray = nullptr;
    } context;
    const double start_s = io::process_cpu_s();
    for (const Ray& r : nearest) {
        context.ray = &r;
        RTCRayHit query;
        query.ray = bare(r);
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        embree::intersect(scene, context.of_embree, nullptr, query);
    }
    for (const Ray& r : shadow) {
        context.ray = &r;
        RTCRay query = bare(r);
        embree::occlude(scene, context.of_embree, query);
    }
    return io::process_cpu_s() - start_s;
}

template <class Tracer>
std::pair<double, integrator::PathStats> timed(const Tracer& tracer, const apps::RenderSetup& setup,
                                               const integrator::RenderJob& job, V2i size) {
    Film film(size, {0, 0, size.x, size.y}, {});
    integrator::RenderMonitor monitor;
    integrator::ThreadExecutor executor(1);
    const double start_s = io::process_cpu_s();
    const integrator::RenderResult result =
        integrator::render(tracer, *setup.view.camera, job, film, executor, monitor);
    return {io::process_cpu_s() - start_s, result.stats};
}

int run(int argc, char** argv) {
    CLI::App app("Traversal floor of a render.");
    apps::SceneRequest request;
    std::string look_at, size = "640x480";
    integrator::RenderJob job;
    job.end_sample = 4;
    app.add_option("scene", request.scene)->required();
    app.add_option("--look-at", look_at);
    app.add_option("--fov", request.camera.fov_deg);
    app.add_option("--env", request.environment);
    app.add_option("--size", size);
    app.add_option("--spp", job.end_sample);
    app.add_option("--traversal", request.traversal)
        ->transform(CLI::CheckedTransformer(std::map<std::string, Traversal>{
            {"robust", Traversal::Robust}, {"fast", Traversal::Fast}}));
    CLI11_PARSE(app, argc, argv);
    request.size = apps::parse_size("--size", size);
    if (!look_at.empty()) {
        const auto v = apps::parse_numbers("--look-at", look_at, 6);
        request.camera.look_at = {V3f(v[0], v[1], v[2]), V3f(v[3], v[4], v[5])};
    }
    flush_denormals();
    const apps::RenderSetup setup = apps::set_up_render(request, [](const std::string&) {});
    const integrator::PathOptions options;
    const integrator::PathTracer<Bvh> tracer(*setup.prepared.scene, *setup.prepared.bvh,
                                             *setup.prepared.lights, options);
    const Recorder recorder{*setup.prepared.bvh, {}, {}};
    const integrator::PathTracer<Recorder> recording(*setup.prepared.scene, recorder,
                                                     *setup.prepared.lights, options);
    (void)timed(recording, setup, job, request.size);

    // Pairs, as the machine's speed drifts; the medians are printed.
    std::vector<double> ratios, surface_ns, vertex_ns, floors_ns;
    for (int i = 0; i < 5; ++i) {
        const auto [render_s, stats] = timed(tracer, setup, job, request.size);
        const double floor_s =
            retrace_s(setup.prepared.bvh->native(), recorder.nearest, recorder.shadow);
        const double rays = static_cast<double>(recorder.nearest.size() + recorder.shadow.size());
        ratios.push_back(floor_s / render_s);
        const double outside_ns = 1e9 * (render_s - floor_s);
        surface_ns.push_back(outside_ns / static_cast<double>(stats.vertices));
        // Every path ray ends in a vertex that is shaded: on a surface or on the sky.
        vertex_ns.push_back(outside_ns / static_cast<double>(recorder.nearest.size()));
        floors_ns.push_back(1e9 * floor_s / rays);
        fmt::print("render {:.3f} s, floor {:.3f} s for {:.0f} rays, {} vertices, {} samples\n",
                   render_s, floor_s, rays, stats.vertices, stats.samples);
    }
    const auto median = [](std::vector<double>& v) {
        std::sort(v.begin(), v.end());
        return v[v.size() / 2];
    };
    const double ratio = median(ratios);  // sorts: the first and last are the extremes
    fmt::print("floor / render {:.3f} ({:.3f} to {:.3f}); floor {:.0f} ns a ray\n", ratio,
               ratios.front(), ratios.back(), median(floors_ns));
    fmt::print("outside traversal: {:.0f} ns a path vertex (surface or sky), {:.0f} ns a surface\n",
               median(vertex_ns), median(surface_ns));
    return 0;
}

}  // namespace
}  // namespace petzval

int main(int argc, char** argv) {
    return petzval::run(argc, argv);
}
