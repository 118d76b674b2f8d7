// SPDX-License-Identifier: Apache-2.0
// The checks that a glTF file passes before anybody reads it, grouped by part of the file. Each
// throws InputError with the JSON path. They run in the order in which they stand here: later ones
// rely on what earlier ones found.
//
// Mistakes with one plain meaning were put right before (io/gltf/mend/mend.h), or are accepted here
// with a warning: docs/design/refusals.md has every rule. The checks refuse what would be read out
// of bounds, would not end, or would show something meaningless.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "io/base/json_cursor.h"
#include "io/gltf/schema/schema.h"
#include "io/gltf/validate/accessor.h"
#include "io/gltf/validate/budget.h"
#include "io/gltf/validate/source.h"
#include "io/gltf/validate/use.h"

namespace petzval::io {

/// A file on its way through the checks.
struct GltfCheck {
    GltfSource& source;
    JsonCursor root;
    GltfBudget& budget;
    std::vector<GltfAccessor>& accessors = source.accessors;  ///< filled by check_accessors
    GltfUse use{};
    std::vector<size_t> played{};       ///< numbers of the animations
    bool reads_all_animations = false;  ///< to tell of faults in the others too

    /// Number of things in the root array `kind` ("meshes" ...).
    [[nodiscard]] size_t count(const char* kind) const { return root.length(kind); }
    void warn(const JsonCursor& at, const std::string& message) {
        source.warnings.add(at.path(), message);
    }
};

/// Checks types, lengths and ranges of the properties that a thing has.
void check_properties(const JsonCursor& thing, std::span<const GltfProperty>);
/// Checks that asset.version is 2.x and asset.minVersion at most 2.0.
void check_asset(const GltfCheck&);
/// Lists the extensions of the file in its source. Warns of each that is ignored with an effect, or
/// stands in a wrong place.
void list_extensions(GltfCheck&);
/// Checks that no listed extension is refused.
void check_extensions(const GltfCheck&);
/// Checks that the root arrays hold objects, and that names are strings.
void check_collections(const GltfCheck&);
/// Decodes each bufferView that something needs and whose data are in KHR_meshopt_compression or
/// EXT_meshopt_compression only, into a buffer of its own: from here on the file is as if it had
/// never been compressed.
void decode_buffer_views(GltfCheck&);
/// Checks that every bufferView lies in its buffer. Comes before the images are read.
void check_buffer_views(GltfCheck&);
/// Decodes each primitive whose data are in KHR_draco_mesh_compression only, into buffers,
/// bufferViews and accessors of its own. Comes between bufferViews and accessors.
void decode_primitives(GltfCheck&);
/// Checks that every accessor, sparse or not, lies in its bufferView, and that zero-filled ones are
/// not absurdly long.
void check_accessors(GltfCheck&);
/// Checks textures, samplers, images and their kind.
void check_textures(GltfCheck&);
void check_materials(GltfCheck&);
/// Greatest number of morph targets of a mesh's primitives, once it is checked; 0 for what is no
/// mesh.
[[nodiscard]] size_t morph_target_count(const nlohmann::json& mesh);
/// Checks attributes, indices and morph targets: references, formats and counts.
void check_meshes(GltfCheck&);
/// Checks which materials the variants of primitives map to.
void check_variants(GltfCheck&);
void check_cameras(GltfCheck&);
void check_lights(GltfCheck&);
/// Checks EXT_lights_image_based: numbers, images, and the lights that scenes name.
void check_image_lights(GltfCheck&);
void check_skins(const GltfCheck&);
/// Checks nodes and scenes: the references, the transforms, and that the nodes form trees.
void check_nodes(GltfCheck&);
/// Checks and decodes the animations that are played, and warns of channels that are left out and
/// of other animations that are broken.
void check_animations(GltfCheck&);
/// Checks values in the buffers: vertex and joint indices in range.
void check_data(const GltfCheck&);

}  // namespace petzval::io
