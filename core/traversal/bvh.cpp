// SPDX-License-Identifier: Apache-2.0
#include "core/traversal/bvh.h"

#include <embree3/rtcore.h>
#include <pmmintrin.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <map>
#include <new>
#include <stdexcept>
#include <string>

#include "core/scene/coverage.h"
#include "core/scene/motion.h"
#include "core/traversal/barycentric.h"
#include "core/traversal/mask_map.h"

namespace petzval {
namespace {

struct Context {
    RTCIntersectContext embree;  // first: Embree hands back a pointer to it
    const Ray* ray;              // in world space; Embree's own is in that of the instance
    explicit Context(const Ray& r) : ray(&r) { rtcInitIntersectContext(&embree); }
};

// Of a ray that looks for the nearest hit, and of one that wants all hits.
struct NearestContext : Context {
    const PassedBlends* passed;
};
struct AllContext : NearestContext {
    std::vector<Hit>* all;
};

// Of a shadow ray. Without a list its BLEND surfaces are drawn.
struct ShadowContext : Context {
    PassedBlends* blends = nullptr;
    bool too_many = false, panes = false;
};

template <class OfRay>
OfRay& context_of(const RTCFilterFunctionNArguments* args) {
    return static_cast<OfRay&>(*reinterpret_cast<Context*>(args->context));
}

uint32_t instance_of(uint32_t inst_id, uint32_t geom_id) {
    return inst_id != RTC_INVALID_GEOMETRY_ID ? inst_id : geom_id;
}

// A triangle that Embree asks about, and how much of it covers at the ray. Embree may ask twice for
// one (spatial splits): the second answer must be the first one.
struct Asked {
    uint32_t instance, triangle;
    float covered;

    explicit Asked(const RTCFilterFunctionNArguments* args) {
        const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
        const auto& scene = *static_cast<const Scene*>(args->geometryUserPtr);
        const auto& context = context_of<Context>(args);
        instance = instance_of(hit.instID[0], hit.geomID), triangle = hit.primID;
        covered = coverage(scene, instance, triangle,
                           barycentric(scene, instance, triangle, *context.ray));
    }
    // Whether a ray that meets it with a chance does not.
    [[nodiscard]] bool passed(float chance, const Ray& ray) const {
        return coverage_number(ray.alpha_seed, instance, triangle) >= chance;
    }
};

// Embree's filter callbacks; a packet has one ray, as only the single-ray calls are used.
void filter(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const Asked asked(args);
    if (asked.passed(asked.covered, *context_of<Context>(args).ray)) args->valid[0] = 0;
}

// For MASK: the answers of filter(), most of them without the exact place of the hit.
void filter_mapped(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);  // as long as the way to the hit
    const auto& mesh = *static_cast<const MaskedMesh*>(args->geometryUserPtr);
    const Scene& scene = mesh.scene();
    const Ray& in_world = *context_of<Context>(args).ray;
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
void filter_weighed(const RTCFilterFunctionNArguments* args) {
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
void list_weighed(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    auto& context = context_of<ShadowContext>(args);
    if (!context.blends) return filter(args);
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
void pass_pane(const RTCFilterFunctionNArguments* args) {
    context_of<ShadowContext>(args).panes = true;
    args->valid[0] = 0;
}

// Notes a hit and goes on. Embree's own coordinates are left out, as barycentric() finds them.
void note(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& context = context_of<AllContext>(args);
    context.all->push_back(
        {V2f(0.f), instance_of(hit.instID[0], hit.geomID), hit.primID, context.ray->time});
    args->valid[0] = 0;
}

// Lets rays pass backs. Ray and normal are in one space, whose mirroring changes no front into a
// back: glTF turns the winding of what is mirrored.
void pass_back(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] != -1) return;
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
    if (ray.dir_x * hit.Ng_x + ray.dir_y * hit.Ng_y + ray.dir_z * hit.Ng_z >= 0.f)
        args->valid[0] = 0;
}

RTCRay to_embree(const Ray& r, float t_min = 0) {
    RTCRay ray;
    ray.org_x = r.origin.x, ray.org_y = r.origin.y, ray.org_z = r.origin.z;
    ray.dir_x = r.direction.x, ray.dir_y = r.direction.y, ray.dir_z = r.direction.z;
    // tnear above 0: in a plane through the origin of an axis nothing rounds, so that no offset
    // moves a ray off it, and it would meet at 0 what it leaves.
    ray.tnear = std::max(std::numeric_limits<float>::min(), t_min), ray.tfar = r.t_max;
    ray.time = r.time, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
    return ray;
}

// Whether Embree can trace a ray: Debian's ends the program on others, with a bound of 1.844e18 for
// every coordinate.
bool traceable(const Ray& r) {
    const f4 bound = splat(1.8e18f);
    const V3f &o = r.origin, &d = r.direction;
    const f4 first{o.x, o.y, o.z, d.x}, last{o.z, d.x, d.y, d.z};
    const m4 within = (first <= bound) & (first >= -bound) & (last <= bound) & (last >= -bound);
    const m4 pairs = within & __builtin_shufflevector(within, within, 2, 3, 0, 1);
    return (pairs[0] & pairs[1]) != 0 && r.t_max >= 0.f;
}

// Embree's callback for memory that it takes (or gives back: below 0).
bool count_bytes(void* sum, ssize_t bytes, bool) {
    *static_cast<std::atomic<int64_t>*>(sum) += bytes;
    return true;
}

}  // namespace

// Embree takes the widest instructions it finds. Each set rounds otherwise, so it gets the one that
// every processor has that this program runs on.
constexpr const char* kDeviceConfig = "isa=avx2";

struct Bvh::Impl {
    const Scene& scene;
    RTCDevice device = nullptr;
    RTCScene top = nullptr;
    std::vector<RTCScene> shared;  // one for each mesh that instances share, else null
    bool has_cutouts = false, has_blends = false;
    std::map<uint32_t, MaskMap> mask_maps;  // by material
    std::deque<MaskedMesh> masked;
    std::atomic<int64_t> bytes = 0;

    explicit Impl(const Scene& s) : scene(s) {}
    ~Impl() {
        for (RTCScene s : shared)
            if (s) rtcReleaseScene(s);
        if (top) rtcReleaseScene(top);
        if (device) rtcReleaseDevice(device);
    }

    void check() const {
        const RTCError error = rtcGetDeviceError(device);
        if (error == RTC_ERROR_NONE) return;
        if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
        throw std::runtime_error("Embree failed with error " + std::to_string(error));
    }

    RTCScene new_scene(Traversal traversal) const {
        RTCScene made = rtcNewScene(device);
        int flags = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
        if (traversal == Traversal::Robust) flags |= RTC_SCENE_FLAG_ROBUST;
        rtcSetSceneFlags(made, static_cast<RTCSceneFlags>(flags));
        rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_HIGH);
        return made;
    }

    std::optional<Hit> nearest(const Ray& r, float t_min, RTCFilterFunctionN also,
                               const PassedBlends* passed) const {
        if (!traceable(r)) return std::nullopt;
        NearestContext context{Context(r), passed};
        context.embree.filter = also;
        RTCRayHit query;
        query.ray = to_embree(r, t_min);
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(top, &context.embree, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
        // Not Embree's own coordinates: they come from an approximate reciprocal, of which
        // processors of different makers have different ones.
        const uint32_t instance = instance_of(query.hit.instID[0], query.hit.geomID);
        const uint32_t triangle = query.hit.primID;
        return Hit{barycentric(scene, instance, triangle, r), instance, triangle, r.time};
    }

    // Whether a ray meets what its context does not let it pass.
    bool is_met(const Ray& r, ShadowContext& context) const {
        RTCRay ray = to_embree(r);
        rtcOccluded1(top, &context.embree, &ray);
        return ray.tfar < 0.f;
    }

    RTCGeometry triangles(uint32_t mesh_id) {
        const Mesh& mesh = scene.meshes[mesh_id];
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto set_positions = [&](unsigned step, const std::vector<V3f>& positions) {
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3,
                                       positions.data(), 0, sizeof(V3f), positions.size());
        };
        if (mesh.steps.empty())
            set_positions(0, mesh.positions);
        else
            rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(mesh.steps.size()));
        for (unsigned i = 0; i < mesh.steps.size(); ++i) set_positions(i, mesh.steps[i].positions);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles.data(), 0, sizeof(mesh.triangles[0]),
                                   mesh.triangles.size());
        const Material& material = scene.materials[mesh.material];
        if (material.cutout()) {
            has_cutouts = true;
            // Embree wants a pointer to something that may change; the filter only reads.
            rtcSetGeometryUserData(geometry, const_cast<Scene*>(&scene));
            const bool weighed = material.weighed();
            has_blends |= weighed;
            rtcSetGeometryIntersectFilterFunction(geometry, weighed ? filter_weighed : filter);
            rtcSetGeometryOccludedFilterFunction(geometry, weighed ? list_weighed : filter);
            const auto [map, added] = mask_maps.try_emplace(mesh.material, scene, material);
            masked.emplace_back(scene, mesh, map->second);
            bytes += masked.back().bytes() + (added ? map->second.answers.size() : 0);
            if (masked.back().empty()) {
                masked.pop_back();
            } else {
                rtcSetGeometryUserData(geometry, &masked.back());
                rtcSetGeometryIntersectFilterFunction(geometry, filter_mapped);
                rtcSetGeometryOccludedFilterFunction(geometry, filter_mapped);
            }
        }
        if (material.may_be_pane()) rtcSetGeometryOccludedFilterFunction(geometry, pass_pane);
        rtcCommitGeometry(geometry);
        return geometry;
    }
};

Bvh::Bvh(const Scene& scene, Traversal traversal) : impl_(std::make_unique<Impl>(scene)) {
    Impl& d = *impl_;
    d.device = rtcNewDevice(kDeviceConfig);
    if (!d.device) d.check();
    rtcSetDeviceMemoryMonitorFunction(d.device, count_bytes, &d.bytes);
    d.top = d.new_scene(traversal);
    d.shared.resize(scene.meshes.size(), nullptr);

    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        RTCGeometry geometry = nullptr;
        if (instance.identity) {
            geometry = d.triangles(instance.mesh);
        } else {
            RTCScene& part = d.shared[instance.mesh];
            if (!part) {
                part = d.new_scene(traversal);
                RTCGeometry mesh = d.triangles(instance.mesh);
                rtcAttachGeometry(part, mesh);
                rtcReleaseGeometry(mesh);
                rtcCommitScene(part);
            }
            geometry = rtcNewGeometry(d.device, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(geometry, part);
            const auto place = [&](unsigned step, const M44f& to_world) {
                // Imath's rows are Embree's columns.
                rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                                        to_world.getValue());
            };
            if (const auto* const places = places_of(scene, i)) {
                rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(places->size()));
                for (unsigned k = 0; k < places->size(); ++k) place(k, (*places)[k]);
            } else {
                place(0, instance.to_world);
            }
            rtcCommitGeometry(geometry);
        }
        rtcAttachGeometryByID(d.top, geometry, i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(d.top);
    d.check();
}

Bvh::~Bvh() = default;

std::optional<Hit> Bvh::intersect(const Ray& r, const PassedBlends* passed) const {
    if (!passed) return impl_->nearest(r, 0.f, nullptr, nullptr);
    return impl_->nearest(r, passed->t_min, nullptr, passed);
}

std::optional<Hit> Bvh::intersect_front(const Ray& r, float t_min,
                                        const PassedBlends* passed) const {
    return impl_->nearest(r, t_min, pass_back, passed);
}

bool Bvh::occluded(const Ray& r) const {
    ShadowContext context{Context(r)};
    return traceable(r) && impl_->is_met(r, context);
}

Passage Bvh::passage(const Ray& r) const {
    if (!traceable(r)) return {1.f, false};
    ShadowContext context{Context(r)};
    if (!impl_->has_blends) {
        const bool met = impl_->is_met(r, context);
        return {met ? 0.f : 1.f, context.panes};
    }
    PassedBlends blends;
    context.blends = &blends;
    if (impl_->is_met(r, context)) return {0.f, context.panes};
    float left = 1.f;
    if (context.too_many) {
        context.blends = nullptr;
        left = impl_->is_met(r, context) ? 0.f : 1.f;
    } else if (blends.count > 0) {
        const auto begin = blends.passed.begin(), end = begin + blends.count;
        const auto place = [](const auto& p) { return std::pair(p.instance, p.triangle); };
        std::sort(begin, end, [&](auto& a, auto& b) { return place(a) < place(b); });
        for (auto p = begin; p != end; ++p) left *= p->left;
    }
    return {left, context.panes};
}

std::vector<Hit> Bvh::all_hits(const Ray& r) const {
    std::vector<Hit> hits;
    if (!traceable(r) || impl_->scene.volume_boxes.empty()) return hits;
    AllContext context{{Context(r), nullptr}, &hits};
    context.embree.filter = note;
    RTCRayHit query;
    query.ray = to_embree(r);
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->top, &context.embree, &query);
    const auto place = [](const Hit& h) { return std::pair(h.instance, h.triangle); };
    std::sort(hits.begin(), hits.end(),
              [&](const Hit& a, const Hit& b) { return place(a) < place(b); });
    const auto same = [&](const Hit& a, const Hit& b) { return place(a) == place(b); };
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
    for (Hit& h : hits) h.barycentric = barycentric(impl_->scene, h.instance, h.triangle, r);
    return hits;
}

bool Bvh::has_cutouts() const {
    return impl_->has_cutouts;
}

bool Bvh::has_blends() const {
    return impl_->has_blends;
}

uint64_t Bvh::bytes() const {
    return static_cast<uint64_t>(std::max<int64_t>(impl_->bytes, 0));
}

RTCSceneTy* Bvh::native() const {
    return impl_->top;
}

void flush_denormals() {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
}

}  // namespace petzval
