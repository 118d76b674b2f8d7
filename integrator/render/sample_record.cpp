// SPDX-License-Identifier: Apache-2.0
#include "integrator/render/sample_record.h"

#include <ImathLineAlgo.h>

#include <algorithm>

#include "integrator/path/path_impl.h"
#include "integrator/render/sample_batch.h"

namespace petzval::integrator {
namespace {

/// Appends the surfaces with holes in their coverage on a way, in the order of distance.
void add_holes(const Scene& scene, const V3f& from, const V3f& to, float time,
               std::vector<PathEvent>& out) {
    constexpr float kEnd_m = 1e-4f;  // of the way: what lies there is met
    const V3f way = unit(to - from);
    const auto first = static_cast<std::ptrdiff_t>(out.size());
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        if (!scene.materials[mesh.material].cutout()) continue;
        for (uint32_t k = 0; k < mesh.triangles.size(); ++k) {
            const auto [a, b, c] = triangle_corners(scene, i, k, time);
            V3f at(0.f), weights(0.f);
            bool front;
            const bool meets = Imath::intersect({from, to}, a, b, c, at, weights, front);
            const float from_m = (at - from).dot(way), left_m = (to - at).dot(way);
            if (meets && from_m > kEnd_m && left_m > kEnd_m)
                out.push_back(
                    {.step = PathStep::Hole,
                     .number = from_m,
                     .surface = make_surface(scene, way, {{weights.y, weights.z}, i, k, time})});
        }
    }
    std::ranges::sort(out.begin() + first, out.end(), {}, &PathEvent::number);
}

}  // namespace

SampleRecord SampleRecord::of(const Scene& scene, const Bvh& bvh, const LightChoice& lights,
                              const PathOptions& options, const camera::Camera& camera,
                              const RenderJob& job, V2i frame_px, SampleId id) {
    SampleRecord out;
    std::vector<PathEvent> events;
    const PathTracer<Bvh, PathRecorder> tracer(scene, bvh, lights, options, {{}, &events});
    Film film(frame_px, {id.x, id.y, id.x + 1, id.y + 1}, {});
    PathStats stats;
    SampleBatch batch(tracer, camera, job, frame_px, &film, stats);
    batch.add(id);
    batch.render();
    out.point_px = batch.points_[0].film * V2f(frame_px);
    out.bands = batch.bands_[0];
    out.lens = batch.samples_[0].lanes;
    out.rays.assign(batch.samples_[0].begin(), batch.samples_[0].end());
    out.film = film.colour(id.x, id.y);
    out.left_out = film.left_out(id.x, id.y) > 0;
    Ray begin;
    V3f from;
    size_t path = 0;
    for (PathEvent& event : events) {
        if (event.step == PathStep::Begins) {
            const camera::CameraPath& of = out.rays[path++];
            event.lanes = zero_off(of.lanes, of.weight * of.mis_weight);
            begin = event.ray;
            from = begin.origin;
        }
        if (event.step == PathStep::LeavesScene)
            add_holes(scene, from, from + event.ray.direction * 1e6f, begin.time, out.events);
        if (event.surface) {
            add_holes(scene, from, event.surface->p, begin.time, out.events);
            event.number = (event.surface->p - from).length();
            from = event.surface->p;
        }
        out.events.push_back(event);
        if (event.step != PathStep::ShadowRay || event.number > 0) continue;
        if (const auto hit = bvh.intersect(event.ray)) {
            const Surface s = make_surface(scene, event.ray.direction, *hit);
            out.events.push_back({.step = PathStep::Blocks,
                                  .number = (s.p - event.ray.origin).length(),
                                  .surface = s});
        }
    }
    return out;
}

}  // namespace petzval::integrator
