// SPDX-License-Identifier: Apache-2.0
#include "core/traversal/bvh_filters.h"

#include "core/scene/coverage.h"
#include "core/traversal/barycentric.h"
#include "core/traversal/mask_map.h"

namespace petzval {
namespace {

template <class OfRay>
OfRay& context_of(const RTCFilterFunctionNArguments* args) {
    return static_cast<OfRay&>(*reinterpret_cast<FilteredRay*>(args->context));
}

// A triangle that Embree asks about, and how much of it covers at the ray. Embree may ask twice for
// one (spatial splits): the second answer must be the first one.
struct Asked {
    uint32_t instance, triangle;
    float covered;

    explicit Asked(const RTCFilterFunctionNArguments* args) {
        const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
        const auto& scene = *static_cast<const Scene*>(args->geometryUserPtr);
        const auto& context = context_of<FilteredRay>(args);
        instance = instance_of(hit.instID[0], hit.geomID), triangle = hit.primID;
        covered = coverage(scene, instance, triangle,
                           barycentric(scene, instance, triangle, *context.ray));
    }
    // Whether a ray that meets it with a chance does not.
    [[nodiscard]] bool passed(float chance, const Ray& ray) const {
        return coverage_number(ray.alpha_seed, instance, triangle) >= chance;
    }
};

}  // namespace

// Lets a ray meet a surface with the chance of its coverage.
void bvh_filters::draw(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const Asked asked(args);
    if (asked.passed(asked.covered, *context_of<FilteredRay>(args).ray)) args->valid[0] = 0;
}

// For MASK: the answers of draw(), most of them without the exact place of the hit.
void bvh_filters::draw_mapped(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);  // as long as the way to the hit
    const auto& mesh = *static_cast<const MaskedMesh*>(args->geometryUserPtr);
    const Scene& scene = mesh.scene();
    const Ray& in_world = *context_of<FilteredRay>(args).ray;
    const uint32_t instance = instance_of(hit.instID[0], hit.geomID), triangle = hit.primID;
    const float more = hit.instID[0] != RTC_INVALID_GEOMETRY_ID
                           ? MaskedMesh::rounding_of(scene.instances[instance], in_world, ray.tfar)
                           : 0.f;
    std::optional<bool> covers =
        mesh.covers(triangle, {hit.u, hit.v}, {hit.Ng_x, hit.Ng_y, hit.Ng_z},
                    {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tfar, more);
    if (!covers)
        covers = coverage(scene, instance, triangle,
                          barycentric(scene, instance, triangle, in_world)) > 0.f;
    if (!*covers) args->valid[0] = 0;
}

// For surfaces that paths weigh.
void bvh_filters::draw_weighed(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const auto& context = context_of<NearestContext>(args);
    const PassedBlends* const passed = context.passed;
    const Asked asked(args);
    const bool weighed = passed && !passed->full();
    if ((passed && passed->has(asked.instance, asked.triangle)) ||
        asked.passed(weighed ? chance_met(asked.covered) : asked.covered, *context.ray))
        args->valid[0] = 0;
}

// For shadow rays: lists what they pass. The product is taken when all is known, in an order of its
// own.
void bvh_filters::list_weighed(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    auto& context = context_of<ShadowContext>(args);
    if (!context.blends) return draw(args);
    const Asked asked(args);
    if (asked.covered >= 1.f) return;
    args->valid[0] = 0;
    if (asked.covered <= 0.f || context.blends->has(asked.instance, asked.triangle)) return;
    context.too_many |= context.blends->full();
    if (!context.too_many)
        context.blends->add({asked.instance, asked.triangle, 1.f - asked.covered});
}

// Lets rays that only ask whether the way is free pass panes. What a pane takes from them is not
// found here, where a triangle may be asked for twice and in any order.
void bvh_filters::pass_pane(const RTCFilterFunctionNArguments* args) {
    context_of<ShadowContext>(args).panes = true;
    args->valid[0] = 0;
}

}  // namespace petzval
