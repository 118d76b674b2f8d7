// SPDX-License-Identifier: Apache-2.0
// Cameras and lights. What they must have was given to them when they were mended, or their type
// was taken (io/gltf/mend/mend_cameras.cpp).
#include "io/base/json_parse.h"
#include "io/gltf/validate/check.h"
#include "io/gltf/validate/extras.h"

namespace petzval::io {
namespace {

/// Warns of a type that is not known; one that has none was told of when it was mended.
void warn_of_type(GltfCheck& check, const JsonCursor& thing, const std::string& type) {
    if (!type.empty()) check.warn(thing, "is of the unknown type \"" + printable(type) + "\"");
}

void check_light(GltfCheck& check, const JsonCursor& light) {
    (void)light.text_or("name", "");
    check_properties(light, rows_at(schema::kLightRows, ""));
    check_light_extras(light);
    const std::string type = light.text("type");
    if (type == "spot")
        check_properties(light, rows_at(schema::kLightRows, "spot"));
    else if (type != "point" && type != "directional")
        warn_of_type(check, light, type);
}

}  // namespace

void check_cameras(GltfCheck& check) {
    for (const JsonCursor& camera : check.root.objects("cameras")) {
        (void)camera_extras(camera);
        const std::string type = camera.text("type");
        if (type == "perspective" || type == "orthographic")
            check_properties(camera, rows_at(schema::kCameraRows, type));
        else
            warn_of_type(check, camera, type);
    }
}

void check_lights(GltfCheck& check) {
    const auto lights = check.root.extension("KHR_lights_punctual");
    if (!lights) return;
    lights->require("lights");
    for (const JsonCursor& light : lights->objects("lights")) check_light(check, light);
}

}  // namespace petzval::io
