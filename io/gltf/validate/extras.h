// SPDX-License-Identifier: Apache-2.0
// Petzval's own part of a glTF file: "extras": {"petzval": {...}} on materials, lights, nodes,
// cameras and scenes.
#pragma once

#include <optional>

#include "io/base/json_cursor.h"
#include "io/gltf/validate/camera_extras.h"
#include "io/gltf/validate/scene_extras.h"

namespace petzval::io {

/// extras.petzval of an object. Other people's extras may be of any type: they are ignored.
[[nodiscard]] std::optional<JsonCursor> petzval_extras(const JsonCursor& owner);

/// extras.petzval of a material, keys and types checked. Throws InputError with the JSON path.
std::optional<JsonCursor> check_material_extras(const JsonCursor& material);
/// Whether a material's extras.petzval make its glass solid, so that light is refracted into it:
/// "solid" says so, or that it is thin; without that a named glass is solid. Nothing where they say
/// nothing. Throws InputError with the JSON path where "solid" is neither true nor false.
[[nodiscard]] std::optional<bool> is_solid(const JsonCursor& material);
/// Checks an entry of KHR_lights_punctual's lights likewise.
void check_light_extras(const JsonCursor& light);
/// Radius of a punctual light, metres in the scene: radius_m in extras.petzval, else a number
/// `radius` in extras itself, where custom properties of modellers end up. Throws InputError with
/// the JSON path where the first is not from 0 to 10^6.
[[nodiscard]] std::optional<float> light_radius_m(const JsonCursor& light);

/// Angle that the disc of a directional light takes up in the sky, degrees: angle_deg in
/// extras.petzval, 0 where it is absent. Throws InputError where it is not from 0 to 180.
[[nodiscard]] float light_angle_deg(const JsonCursor& light);
/// Whether extras.petzval of a light, or of a node with an area, says "visible": false.
[[nodiscard]] bool is_unseen(const JsonCursor& owner);

/// A node that shines as a flat lamp.
struct AreaExtras {
    V2f size_m;
    bool ellipse = false;
    std::optional<float> intensity_cd;  ///< absent: that of the node's light
    std::optional<V3f> color;           ///< likewise
};
/// Area lamp in extras.petzval of a node: {"area": [1, 0.5], "shape": "ellipse", "intensity_cd":
/// 40, "color": [1, 1, 1], "illuminant": "a", "visible": false}, of which only "area" must be
/// there. Nothing where the node has no area. Throws InputError as camera_extras() does.
[[nodiscard]] std::optional<AreaExtras> area_extras(const JsonCursor& node);

/// Settings in extras.petzval of a scene: {"sky": "dusk.hdr", "sky_rotation_deg": 90,
/// "exposure_ev": -7, "view": "ACES"}, each of which may be absent. Throws InputError likewise.
[[nodiscard]] SceneExtras scene_extras(const JsonCursor& scene);

/// Camera settings in extras.petzval of a camera: {"lens": "takumar-50mm-f1.2", "fstop": 2,
/// "focus_m": 1.5, "aperture": "polygon:6", "sensor_mm": [36, 24]}, each of which may be absent.
/// Throws InputError with the JSON path for a key that is not known and a value that is not as it
/// should be.
[[nodiscard]] CameraExtras camera_extras(const JsonCursor& camera);

}  // namespace petzval::io
