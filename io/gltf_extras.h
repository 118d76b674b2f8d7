// SPDX-License-Identifier: Apache-2.0
// Petzval's own part of a glTF file: "extras": {"petzval": {...}} on materials, lights and cameras.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "io/gltf.h"
#include "io/json_cursor.h"

namespace petzval {

/// extras.petzval of an object. Other people's extras may be of any type: they are none of ours.
[[nodiscard]] std::optional<JsonCursor> petzval_extras(const JsonCursor& owner);

/// Refuses a key that is not known. what: "material" ... Throws InputError with the JSON path.
void require_known_extras(const JsonCursor& owner, const char* what,
                          const std::vector<std::string_view>& known);

/// Of a camera: {"lens": "takumar-50mm-f1.2", "fstop": 2, "focus_m": 1.5, "aperture": "polygon:6",
/// "sensor_mm": [36, 24]}, each of which may be absent. Throws InputError with the JSON path for a
/// key that is not known and a value that is not as it should be.
[[nodiscard]] CameraWishes camera_wishes(const JsonCursor& camera);

}  // namespace petzval
