// SPDX-License-Identifier: Apache-2.0
// KHR_materials_variants. The file is read whatever is wrong in it, as every primitive has a
// material of its own too; only a material that is not there is refused.
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

constexpr const char* kExtension = "KHR_materials_variants";

void check_mapping(GltfCheck& check, const JsonCursor& mapping, size_t variants) {
    const auto material = mapping.index("material", check.count("materials"), "material");
    const size_t mapped = mapping.length("variants");
    if (!material || mapped == 0)
        check.warn(mapping, "maps no variant to a material; it is ignored");
    if (mapped == 0) return;
    for (const auto& variant : mapping.value()["variants"]) {
        if (!variant.is_number_integer()) mapping.fail("variants", "must be an array of indices");
        if (variant < 0 || variant >= variants)
            check.warn(mapping, "maps a variant that is not there; that is ignored");
    }
}

}  // namespace

void check_variants(GltfCheck& check) {
    size_t variants = 0;
    if (const auto list = check.root.extension(kExtension))
        for (const JsonCursor& variant : list->objects("variants")) {
            ++variants;
            (void)variant.text_or("name", "");
        }
    for (const JsonCursor& mesh : check.root.objects("meshes"))
        for (const JsonCursor& primitive : mesh.objects("primitives"))
            if (const auto extension = primitive.extension(kExtension))
                for (const JsonCursor& mapping : extension->objects("mappings"))
                    check_mapping(check, mapping, variants);
}

}  // namespace petzval::io
