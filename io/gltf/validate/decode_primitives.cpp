// SPDX-License-Identifier: Apache-2.0
// KHR_draco_mesh_compression: primitives whose vertices and triangles are compressed.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/gltf/compression/draco_mesh.h"
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

using nlohmann::json;
using Bytes = std::vector<uint8_t>;

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr uint64_t kTriangles = 4, kTriangleStrip = 5;

/// An attribute that is to be decoded: its name, its accessor, and what the accessor says.
struct Wanted {
    std::string name;
    size_t accessor;
    DracoArray array;
};

class PrimitiveDecoder {
  public:
    explicit PrimitiveDecoder(GltfCheck& check)
        : check_(check),
          accessors_(check.root.objects("accessors")),
          views_(check.root.objects("bufferViews")) {}

    /// Decodes a primitive; `value` is its JSON, which then names the new accessors.
    void decode(const JsonCursor& primitive, json& value) {
        const auto draco = primitive.extension(kDraco);
        if (!draco) return;
        const std::vector<Wanted> wanted = wanted_of(primitive, *draco);
        if (needs_decoding(primitive, wanted)) {
            if (wanted.empty()) draco->fail("names no attribute of its primitive");
            const uint64_t mode = primitive.integer_or("mode", kTriangles);
            if (mode != kTriangles && mode != kTriangleStrip)
                draco->fail("goes with triangles and strips of triangles only");
            const json found = decoded(primitive, *draco, wanted, mode);
            value["attributes"].update(found["attributes"]);
            value["indices"] = found["indices"];
            value["mode"] = kTriangles;  // Draco knows no strips
        }
        value["extensions"].erase(kDraco);
    }

    /// Puts what was decoded into the file.
    void store() {
        if (bytes_.empty()) return;
        json& root = check_.source.json;
        for (size_t i = 0; i < bytes_.size(); ++i) {
            root["buffers"].push_back({{"byteLength", bytes_[i].size()}});
            root["bufferViews"].push_back(
                {{"buffer", check_.source.buffers.size()}, {"byteLength", bytes_[i].size()}});
            root["accessors"].push_back(std::move(described_[i]));
            check_.source.buffers.push_back(std::move(bytes_[i]));
        }
        check_.use = find_used(root, check_.played);
    }

  private:
    /// The attributes that the stream holds, those of one's own (_NAME) excepted: nothing reads
    /// them.
    std::vector<Wanted> wanted_of(const JsonCursor& primitive, const JsonCursor& draco) const {
        std::vector<Wanted> wanted;
        const JsonCursor attributes = primitive.object("attributes");
        const auto ids = draco.find_object("attributes");
        if (!ids) return wanted;
        for (const auto& [name, unused] : ids->value().items()) {
            if (name.starts_with('_') || !attributes.has(name.c_str())) continue;
            const uint64_t id = ids->integer(name.c_str());
            if (id > UINT32_MAX) ids->fail(name, "is no id of Draco's");
            const size_t at =
                attributes.required_index(name.c_str(), accessors_.size(), "accessor");
            wanted.push_back({name, at, array_of(accessors_[at], uint32_t(id))});
        }
        return wanted;
    }

    static DracoArray array_of(const JsonCursor& accessor, uint32_t id) {
        DracoArray array{id, 0, component_count(accessor.text("type"))};
        const uint64_t type = accessor.integer("componentType");
        if (type <= 5126) array.component_type = int(type);
        if (component_size(array.component_type) == 0 || array.components == 0 ||
            array.components > 4)
            accessor.fail("is of a type that no vertex has");
        return array;
    }

    /// Whether indices, positions or an attribute of the stream have no data of their own. Where
    /// all have, these are for programs that do not know Draco, and exact.
    bool needs_decoding(const JsonCursor& primitive, const std::vector<Wanted>& wanted) const {
        const auto lacks = [&](std::optional<size_t> accessor) {
            return accessor && !accessors_[*accessor].has("bufferView") &&
                   !accessors_[*accessor].has("sparse");
        };
        const auto index = [&](const JsonCursor& owner, const char* key) {
            return owner.index(key, accessors_.size(), "accessor");
        };
        return lacks(index(primitive, "indices")) ||
               lacks(index(primitive.object("attributes"), "POSITION")) ||
               std::any_of(wanted.begin(), wanted.end(),
                           [&](const Wanted& attribute) { return lacks(attribute.accessor); });
    }

    /// The new "attributes" and "indices". Primitives may share a stream.
    json decoded(const JsonCursor& primitive, const JsonCursor& draco,
                 const std::vector<Wanted>& wanted, uint64_t mode) {
        std::string key = fmt::format("{} {}", draco.integer("bufferView"),
                                      primitive.integer_or("indices", UINT64_MAX));
        for (const Wanted& attribute : wanted)
            key += fmt::format(" {} {} {}", attribute.name, attribute.accessor, attribute.array.id);
        const auto [found, is_new] = known_.try_emplace(key);
        if (is_new) found->second = decode_stream(primitive, draco, wanted, mode);
        return found->second;
    }

    json decode_stream(const JsonCursor& primitive, const JsonCursor& draco,
                       const std::vector<Wanted>& wanted, uint64_t mode) {
        const auto stream = stream_of(draco);
        const DracoHeader header = read_draco_header(stream);
        if (!header.fault.empty()) draco.fail(header.fault);
        uint64_t vertex_bytes = 0;
        std::vector<DracoArray> arrays;
        for (const Wanted& attribute : wanted) {
            const DracoArray& array = attribute.array;
            vertex_bytes += size_t(array.components) * component_size(array.component_type);
            arrays.push_back(array);
        }
        check_.budget.ask_decoded(3 * header.faces * sizeof(uint32_t), draco);
        DracoMesh mesh =
            decode_draco(stream, header, check_.budget.left_to_decode() / vertex_bytes, arrays);
        if (!mesh.fault.empty()) draco.fail(mesh.fault);
        check_.budget.ask_decoded(mesh.vertices * vertex_bytes, draco);

        json out;
        bool agrees = mode != kTriangles || !primitive.has("indices") ||
                      count_of(primitive.integer("indices")) == 3 * header.faces;
        for (size_t i = 0; i < wanted.size(); ++i) {
            const size_t accessor = wanted[i].accessor;
            agrees &= count_of(accessor) == mesh.vertices;
            json described = accessors_[accessor].value();
            described.erase("byteOffset");
            described["count"] = mesh.vertices;
            out["attributes"][wanted[i].name] = add(std::move(described), mesh.arrays[i]);
        }
        if (!agrees)
            check_.warn(draco,
                        "its stream has other numbers of triangles or vertices than its "
                        "accessors; those of the stream are taken");
        out["indices"] =
            add({{"componentType", 5125}, {"type", "SCALAR"}, {"count", 3 * header.faces}},
                mesh.indices);
        return out;
    }

    std::span<const uint8_t> stream_of(const JsonCursor& draco) const {
        const JsonCursor& view =
            views_[draco.required_index("bufferView", views_.size(), "bufferView")];
        const Bytes& buffer = check_.source.buffers[view.integer("buffer")];
        if (buffer.empty()) return {};
        return {buffer.data() + view.integer_or("byteOffset", 0), view.integer("byteLength")};
    }

    uint64_t count_of(size_t accessor) const { return accessors_[accessor].integer("count"); }

    /// Adds an accessor of tightly packed bytes; returns its index.
    size_t add(json described, Bytes& bytes) {
        described["bufferView"] = views_.size() + bytes_.size();
        described_.push_back(std::move(described));
        bytes_.push_back(std::move(bytes));
        return accessors_.size() + bytes_.size() - 1;
    }

    GltfCheck& check_;
    const std::vector<JsonCursor> accessors_, views_;  ///< those of the file
    std::map<std::string, json> known_;                ///< what a stream was decoded to
    std::vector<json> described_;                      ///< the new accessors ...
    std::vector<Bytes> bytes_;                         ///< ... and what each holds
};

}  // namespace

void decode_primitives(GltfCheck& check) {
    PrimitiveDecoder decoder(check);
    const auto meshes = check.root.objects("meshes");
    for (size_t m = 0; m < meshes.size(); ++m) {
        const auto primitives = meshes[m].objects("primitives");
        json& values = check.source.json["meshes"][m]["primitives"];
        for (size_t p = 0; p < primitives.size(); ++p) decoder.decode(primitives[p], values[p]);
    }
    decoder.store();
}

}  // namespace petzval::io
