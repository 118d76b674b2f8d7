// SPDX-License-Identifier: Apache-2.0
#include <new>
#include <stdexcept>
#include <string>

#include "core/scene/motion.h"
#include "core/traversal/bvh_filters.h"
#include "core/traversal/bvh_impl.h"

namespace petzval {
namespace {

// Embree takes the widest instructions it finds. Each set rounds otherwise, so it gets the one that
// every processor has that this program runs on.
constexpr const char* kDeviceConfig = "isa=avx2";

// Embree's callback for memory that it takes (or gives back: below 0).
bool count_bytes(void* sum, ssize_t bytes, bool) {
    *static_cast<std::atomic<int64_t>*>(sum) += bytes;
    return true;
}

}  // namespace

Bvh::Impl::~Impl() {
    for (RTCScene s : shared)
        if (s) rtcReleaseScene(s);
    if (top) rtcReleaseScene(top);
    if (device) rtcReleaseDevice(device);
}

void Bvh::Impl::check() const {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error("Embree failed with error " + std::to_string(error));
}

RTCScene Bvh::Impl::new_scene(Traversal traversal) const {
    RTCScene made = rtcNewScene(device);
    int flags = embree::kFilterOfCall;
    if (traversal == Traversal::Robust) flags |= RTC_SCENE_FLAG_ROBUST;
    rtcSetSceneFlags(made, static_cast<RTCSceneFlags>(flags));
    rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_HIGH);
    return made;
}

RTCGeometry Bvh::Impl::triangles(uint32_t mesh_id) {
    using namespace bvh_filters;
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
        rtcSetGeometryIntersectFilterFunction(geometry, weighed ? draw_weighed : draw);
        rtcSetGeometryOccludedFilterFunction(geometry, weighed ? list_weighed : draw);
        const auto [map, added] = mask_maps.try_emplace(mesh.material, scene, material);
        masked.emplace_back(scene, mesh, map->second);
        bytes += masked.back().bytes() + (added ? map->second.answers.size() : 0);
        if (masked.back().empty()) {
            masked.pop_back();
        } else {
            rtcSetGeometryUserData(geometry, &masked.back());
            rtcSetGeometryIntersectFilterFunction(geometry, draw_mapped);
            rtcSetGeometryOccludedFilterFunction(geometry, draw_mapped);
        }
    }
    if (material.may_be_pane()) rtcSetGeometryOccludedFilterFunction(geometry, pass_pane);
    rtcCommitGeometry(geometry);
    return geometry;
}

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

}  // namespace petzval
