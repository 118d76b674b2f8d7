// SPDX-License-Identifier: Apache-2.0
// Mending of a glTF file's JSON, before the checks see it. Mistakes of exporters that have one
// plain meaning are put right: in silence where it is rounding, else with a warning that names
// place, value and what was done. docs/design/refusals.md has the list. Mistakes without a plain
// meaning stay as they are, and the checks refuse them.
#pragma once

#include "io/gltf/mend/json_editor.h"

namespace petzval::io {

/// Mends the whole document, part by part as below.
void mend_gltf(nlohmann::json& root, WarningLog&);

/// Takes away null members, references of -1, empty arrays for objects and names that are no text.
void mend_members(const JsonEditor& root);
/// Mends asset.version, and the lists of extensions: what is used but not declared is declared.
void mend_header(const JsonEditor& root);
void mend_materials(const JsonEditor& root);
/// Mends images, samplers and textures; a texture's source becomes that of EXT_texture_webp.
void mend_textures(const JsonEditor& root);
void mend_cameras(const JsonEditor& root);
void mend_lights(const JsonEditor& root);
/// Mends nodes and the lists of scenes.
void mend_nodes(const JsonEditor& root);
/// Mends bufferViews and accessors.
void mend_accessors(const JsonEditor& root);
void mend_meshes(const JsonEditor& root);

}  // namespace petzval::io
