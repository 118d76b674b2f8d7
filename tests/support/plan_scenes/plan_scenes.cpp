// SPDX-License-Identifier: Apache-2.0
#include "tests/support/plan_scenes/plan_scenes.h"

#include <fmt/format.h>

#include "tests/support/plan_scenes/kinds.h"

namespace petzval::test {
namespace {

struct Kind {
    const char* name;
    void (*add)(PlanWorld&);
};
constexpr std::array<Kind, kPlanSceneKinds> kKinds{{{"prism", add_prisms},
                                                    {"lamps", add_lamps},
                                                    {"barcode", add_barcode},
                                                    {"glints", add_glints},
                                                    {"caustic", add_caustics},
                                                    {"texture", add_textures},
                                                    {"spectra", add_spectra},
                                                    {"rim", add_rim}}};

}  // namespace

PlanScene plan_scene(uint32_t index) {
    const Kind& kind = kKinds[index % kPlanSceneKinds];
    PlanWorld world(index, kind.name);
    kind.add(world);
    return world.finish();
}

apps::SceneRequest PlanScene::save(const std::filesystem::path& folder) const {
    apps::SceneRequest out = request;
    out.scene = folder / "scene.gltf";
    save_bytes(out.scene, {reinterpret_cast<const uint8_t*>(gltf.data()), gltf.size()});
    return out;
}

std::string PlanScene::options() const {
    const apps::CameraRequest& camera = request.camera;
    std::string out = fmt::format("--size {}x{} --look-at 0,0,0,0,0,-1 --tolerance {}%",
                                  request.size.x, request.size.y, 100 * tolerance);
    const auto add = [&](const char* name, const auto& value) {
        if (value) out += fmt::format(" {} {}", name, *value);
    };
    if (request.background)
        out += fmt::format(" --background {},{},{}", (*request.background)[0],
                           (*request.background)[1], (*request.background)[2]);
    add("--lens", camera.lens);
    add("--fov", camera.fov_deg);
    add("--fstop", camera.fstop);
    if (camera.lens_radius_m) out += fmt::format(" --method lens-radius={}", *camera.lens_radius_m);
    add("--focal-length", camera.focal_length_mm);
    if (camera.sensor_mm)
        out += fmt::format(" --sensor {}x{}", camera.sensor_mm->x, camera.sensor_mm->y);
    if (camera.focus)
        out += fmt::format(" --focus {}", std::get<apps::FocusDistance>(*camera.focus).m);
    return out;
}

}  // namespace petzval::test
