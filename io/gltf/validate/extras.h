// SPDX-License-Identifier: Apache-2.0
// Petzval's own part of a glTF file: "extras": {"petzval": {...}} on materials, lights and cameras.
#pragma once

#include <optional>

#include "io/base/json_cursor.h"
#include "io/gltf/validate/camera_extras.h"

namespace petzval {

/// extras.petzval of an object. Other people's extras may be of any type: they are ignored.
[[nodiscard]] std::optional<JsonCursor> petzval_extras(const JsonCursor& owner);

/// Checks keys and types of a material's extras.petzval. Throws InputError with the JSON path.
void check_material_extras(const JsonCursor& material);
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

/// Camera settings in extras.petzval of a camera: {"lens": "takumar-50mm-f1.2", "fstop": 2,
/// "focus_m": 1.5, "aperture": "polygon:6", "sensor_mm": [36, 24]}, each of which may be absent.
/// Throws InputError with the JSON path for a key that is not known and a value that is not as it
/// should be.
[[nodiscard]] CameraExtras camera_extras(const JsonCursor& camera);

}  // namespace petzval
