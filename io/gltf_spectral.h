// SPDX-License-Identifier: Apache-2.0
// What a glTF file says about wavelengths: KHR_materials_dispersion, and Petzval's own extras,
//     "extras": {"petzval": {"glass": "schott:N-SF11"}}
// A material may name a glass or a metal, and an illuminant; a punctual light an illuminant.
#pragma once

#include "core/scene.h"
#include "io/gltf_tally.h"
#include "io/json_cursor.h"

namespace petzval {

/// Keys and types of a material's extras.petzval. Throws InputError with the JSON path.
void check_material_extras(const JsonCursor& material);
/// The same for an entry of KHR_lights_punctual's lights.
void check_light_extras(const JsonCursor& light);

/// Sets a material's glass, metal and illuminant, and what follows from them (index, base colour),
/// once everything else in it is set. Metals and illuminants are added to the scene, each once.
/// Throws InputError for a name that is in no catalogue.
void read_spectral(const JsonCursor& json, Material&, Scene&, GltfTally&);

/// Place in the scene of the illuminant that extras.petzval names, which is added where it is not
/// yet there; -1 where none is named. Throws InputError for one that is not known.
[[nodiscard]] int32_t read_illuminant(const JsonCursor& owner, Scene&, GltfTally&);

}  // namespace petzval
