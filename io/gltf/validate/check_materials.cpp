// SPDX-License-Identifier: Apache-2.0
// Materials, and the slots of their textures.
#include "io/gltf/validate/check.h"
#include "io/gltf/validate/extras.h"
#include "io/gltf/validate/files.h"

namespace petzval::io {
namespace {

void check_texture_info(const JsonCursor& info, size_t textures) {
    (void)info.required_index("index", textures, "texture");
    if (info.has("texCoord")) (void)info.integer("texCoord");
    check_properties(info, schema::kSlotRows);
    const auto transform = info.extension("KHR_texture_transform");
    if (transform && transform->has("texCoord")) (void)transform->integer("texCoord");
}

/// Every texture slot of an object is called "...Texture".
std::vector<JsonCursor> texture_infos(const JsonCursor& owner) {
    std::vector<JsonCursor> infos;
    for (const auto& [key, unused] : owner.value().items())
        if (key.ends_with("Texture")) infos.push_back(owner.object(key.c_str()));
    return infos;
}

/// The objects of a material that have texture slots: itself, the core model, its extensions.
std::vector<JsonCursor> texture_owners(const JsonCursor& material) {
    std::vector<JsonCursor> owners = {material};
    if (const auto pbr = material.find_object("pbrMetallicRoughness")) owners.push_back(*pbr);
    const auto extensions = material.find_object("extensions");
    if (!extensions) return owners;
    for (const auto& [name, unused] : extensions->value().items())
        owners.push_back(extensions->object(name.c_str()));
    return owners;
}

/// Slots are checked apart, as those of extensions that are not known are checked too.
void check_property(const JsonCursor& owner, const GltfProperty& property) {
    Range range = property.range;
    if (property.mending == Mending::ClampButZero) range.low = 0;  // what lies between was mended
    if (property.kind == PropertyKind::Number)
        (void)owner.number_or(property.key, 0, range);
    else if (property.width() > 0)
        (void)owner.numbers(property.key, property.width(), range);
    else if (property.kind == PropertyKind::Yes || property.kind == PropertyKind::Switch)
        owner.check_bool(property.key);
    else if (property.kind == PropertyKind::Word)
        (void)owner.text_or(property.key, "");
}

}  // namespace

void check_properties(const JsonCursor& thing, std::span<const GltfProperty> properties) {
    each_property(thing, properties, check_property);
}

void check_materials(GltfCheck& check) {
    const size_t textures = check.count("textures");
    for (const JsonCursor& material : check.root.objects("materials")) {
        check_properties(material, schema::kMaterialRows);
        if (const auto extras = check_material_extras(material))
            fetch_reflectance(check.source, *extras, check.budget);
        for (const JsonCursor& owner : texture_owners(material))
            for (const JsonCursor& info : texture_infos(owner)) check_texture_info(info, textures);
    }
}

}  // namespace petzval::io
