// SPDX-License-Identifier: Apache-2.0
// Attributes of vertices in any format of glTF, and the ways in which a file may store them.
#pragma once

#include <array>
#include <random>

#include "tests/support/meshes/encoders.h"
#include "tests/support/tiny_gltf.h"

namespace petzval::test {

/// Random choices that are the same on every machine.
class Dice {
  public:
    explicit Dice(uint32_t seed) : random_(seed) {}
    [[nodiscard]] uint32_t below(size_t n) { return uint32_t(random_() % n); }
    [[nodiscard]] bool comes(uint32_t percent) { return random_() % 100 < percent; }
    [[nodiscard]] double between(double a, double b) { return a + (b - a) * random_() * 0x1p-32; }
    template <class T, size_t n>
    [[nodiscard]] T one_of(const T (&values)[n]) {
        return values[below(n)];
    }

  private:
    std::mt19937 random_;
};

/// A component type of glTF, and whether its integers mean shares of the greatest.
struct Format {
    int component = 5126;
    bool normalized = false;

    [[nodiscard]] size_t size() const {
        return component == 5126 || component == 5125 ? 4 : component < 5122 ? 1 : 2;
    }
    [[nodiscard]] double greatest() const {
        return component == 5120   ? 127
               : component == 5121 ? 255
               : component == 5122 ? 32767
                                   : 65535;
    }
};
constexpr Format kFloat{}, kI8{5120}, kI16{5122}, kU16{5123}, kU8{5121}, kI8n{5120, true},
    kU8n{5121, true}, kI16n{5122, true}, kU16n{5123, true};

/// Calls visit with a value of the C++ type.
template <class Visit>
auto with_type_of(const Format& format, Visit visit) {
    switch (format.component) {
        case 5120:
            return visit(int8_t{});
        case 5121:
            return visit(uint8_t{});
        case 5122:
            return visit(int16_t{});
        case 5123:
            return visit(uint16_t{});
        default:
            return visit(float{});
    }
}

/// Values of all vertices, one after another, each of `width` components.
struct Attribute {
    std::string name;
    size_t width = 3;
    Format format;
    std::vector<double> values;

    [[nodiscard]] size_t count() const { return values.size() / width; }
    /// Bytes of an element, and those with the padding to 4 that vertices need.
    [[nodiscard]] size_t tight() const { return width * format.size(); }
    [[nodiscard]] size_t stride() const { return (tight() + 3) / 4 * 4; }

    /// A value as it is stored.
    [[nodiscard]] double stored(size_t i) const {
        if (format.normalized) return std::round(values[i] * format.greatest());
        return format.component == 5126 ? double(float(values[i])) : std::round(values[i]);
    }
    template <class T>
    [[nodiscard]] std::vector<T> as() const {
        std::vector<T> out;
        for (size_t i = 0; i < values.size(); ++i) out.push_back(static_cast<T>(stored(i)));
        return out;
    }
    /// Elements, each with so many bytes.
    [[nodiscard]] std::vector<uint8_t> bytes(size_t of_element) const {
        return with_type_of(format, [&](auto type) {
            const auto all = as<decltype(type)>();
            std::vector<uint8_t> out(count() * of_element);
            for (size_t i = 0; i < count(); ++i)
                std::memcpy(&out[i * of_element], &all[i * width], tight());
            return out;
        });
    }

    [[nodiscard]] nlohmann::json accessor() const {
        nlohmann::json out = {{"componentType", format.component},
                              {"type", "VEC" + std::to_string(width)},
                              {"count", count()}};
        if (format.normalized) out["normalized"] = true;
        if (name != "POSITION") return out;
        std::array<double, 3> low{}, high{};
        for (size_t i = 0; i < values.size(); ++i) {
            const double x = stored(i);
            low[i % 3] = i < 3 ? x : std::min(low[i % 3], x);
            high[i % 3] = i < 3 ? x : std::max(high[i % 3], x);
        }
        out["min"] = low;
        out["max"] = high;
        return out;
    }

    /// The vertices of these numbers, in that order.
    void gather(const std::vector<uint32_t>& from) {
        std::vector<double> out;
        for (const uint32_t v : from)
            for (size_t k = 0; k < width; ++k) out.push_back(values[v * width + k]);
        values = std::move(out);
    }
};

/// How a file stores attributes.
enum class Storage { Plain, Interleaved, Sparse, Meshopt, Draco };

constexpr const char* kMeshoptExtension = "EXT_meshopt_compression";
constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

/// Writes attributes and indices into a file. end() must come last.
class AttributeWriter {
  public:
    explicit AttributeWriter(TinyGltf& file) : file_(file) {}

    /// Accessors by name.
    nlohmann::json write(const std::vector<Attribute>& attributes, Storage storage, Dice& dice) {
        nlohmann::json out;
        if (storage == Storage::Interleaved) return interleaved(attributes);
        for (const Attribute& attribute : attributes) {
            nlohmann::json accessor = attribute.accessor();
            const bool sparse = attribute.tight() == attribute.stride() && dice.comes(70);
            if (storage == Storage::Sparse && sparse)
                store_sparse(attribute, accessor, dice);
            else
                accessor["bufferView"] = view(attribute, storage == Storage::Meshopt);
            out[attribute.name] = file_.add("accessors", std::move(accessor));
        }
        return out;
    }

    int write_indices(const std::vector<uint32_t>& indices, size_t vertices, bool is_list,
                      Storage storage, Dice& dice) {
        const bool wide = dice.comes(30), narrow = dice.comes(30), as_list = dice.comes(50);
        if (storage == Storage::Meshopt) {
            const size_t stride = wide ? 4 : 2;
            const bool triangles = is_list && as_list;
            const auto stream =
                triangles ? encode_triangles(indices, vertices) : encode_indices(indices, vertices);
            const int at = compressed(stream, indices.size() * stride, stride, indices.size(),
                                      triangles ? "TRIANGLES" : "INDICES");
            return file_.add("accessors", {{"bufferView", at},
                                           {"componentType", wide ? 5125 : 5123},
                                           {"type", "SCALAR"},
                                           {"count", indices.size()}});
        }
        if (wide) return file_.add_accessor<uint32_t>("SCALAR", indices);
        if (narrow) return file_.add_accessor<uint8_t>("SCALAR", {indices.begin(), indices.end()});
        return file_.add_accessor<uint16_t>("SCALAR", {indices.begin(), indices.end()});
    }

    /// Gives a primitive attributes and indices that are in a Draco stream only. keeps_order: other
    /// data of the primitive go by the numbers of vertices.
    void write_draco(const std::vector<Attribute>& attributes, const std::vector<uint32_t>& indices,
                     bool keeps_order, nlohmann::json& primitive) {
        DracoBuilder builder(uint32_t(attributes[0].count()), indices);
        nlohmann::json ids;
        for (const Attribute& attribute : attributes) {
            with_type_of(attribute.format, [&](auto type) {
                builder.add(kind_of(attribute.name), type_of(attribute.format),
                            attribute.as<decltype(type)>(), attribute.format.normalized);
            });
            primitive["attributes"][attribute.name] = file_.add("accessors", attribute.accessor());
            ids[attribute.name] = ids.size();
        }
        const auto stream = builder.encode(keeps_order ? draco::MESH_SEQUENTIAL_ENCODING
                                                       : draco::MESH_EDGEBREAKER_ENCODING);
        primitive["indices"] = file_.add(
            "accessors", {{"componentType", 5125}, {"type", "SCALAR"}, {"count", indices.size()}});
        primitive["extensions"][kDracoExtension] = {{"bufferView", file_.add_view(stream)},
                                                    {"attributes", ids}};
        use(kDracoExtension);
    }

    /// Lists an extension that the file uses.
    void use(const char* extension, bool required = true) {
        for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
            nlohmann::json& names = file_.json[list];
            if (names.is_null()) names = nlohmann::json::array();
            if (std::find(names.begin(), names.end(), extension) == names.end() &&
                (required || list == std::string("extensionsUsed")))
                names.push_back(extension);
            if (names.empty()) file_.json.erase(list);
        }
    }

    void end() {
        if (fallback_ == 0) return;
        file_.json["buffers"] = {{{"byteLength", file_.bin.size()}}, {{"byteLength", fallback_}}};
        file_.json["buffers"][1]["extensions"][kMeshoptExtension]["fallback"] = true;
    }

  private:
    nlohmann::json interleaved(const std::vector<Attribute>& attributes) {
        size_t stride = 0;
        for (const Attribute& attribute : attributes) stride += attribute.stride();
        const size_t count = attributes[0].count();
        std::vector<uint8_t> bytes(count * stride);
        nlohmann::json out;
        size_t offset = 0;
        const size_t at = file_.json.contains("bufferViews") ? file_.json["bufferViews"].size() : 0;
        for (const Attribute& attribute : attributes) {
            const auto own = attribute.bytes(attribute.stride());
            for (size_t i = 0; i < count; ++i)
                std::memcpy(&bytes[i * stride + offset], &own[i * attribute.stride()],
                            attribute.stride());
            nlohmann::json accessor = attribute.accessor();
            accessor.update({{"bufferView", at}, {"byteOffset", offset}});
            out[attribute.name] = file_.add("accessors", std::move(accessor));
            offset += attribute.stride();
        }
        file_.add_view(bytes, {{"byteStride", stride}});
        return out;
    }

    int view(const Attribute& attribute, bool meshopt) {
        const size_t stride = attribute.stride();
        const auto bytes = attribute.bytes(stride);
        if (!meshopt) return file_.add_view(bytes, {{"byteStride", stride}});
        const int at = compressed(encode_attributes(bytes, stride), bytes.size(), stride,
                                  attribute.count(), "ATTRIBUTES");
        file_.json["bufferViews"][size_t(at)]["byteStride"] = stride;
        return at;
    }

    /// A bufferView of a stream of meshoptimizer's, without the plain data.
    int compressed(const std::vector<uint8_t>& stream, size_t bytes, size_t stride, size_t count,
                   const char* mode) {
        use(kMeshoptExtension);
        file_.bin.resize((file_.bin.size() + 3) / 4 * 4);
        nlohmann::json extension = {{"buffer", 0},
                                    {"byteOffset", file_.bin.size()},
                                    {"byteLength", stream.size()},
                                    {"byteStride", stride},
                                    {"count", count},
                                    {"mode", mode}};
        file_.bin.insert(file_.bin.end(), stream.begin(), stream.end());
        nlohmann::json view = {{"buffer", 1}, {"byteOffset", fallback_}, {"byteLength", bytes}};
        view["extensions"][kMeshoptExtension] = std::move(extension);
        fallback_ += (bytes + 3) / 4 * 4;
        return file_.add("bufferViews", std::move(view));
    }

    // Some elements replace those of a view, or zeros.
    void store_sparse(const Attribute& attribute, nlohmann::json& accessor, Dice& dice) {
        const size_t size = attribute.tight();
        auto base = attribute.bytes(size);
        const auto all = base;
        const bool has_view = dice.comes(60);
        std::vector<uint16_t> slots;
        std::vector<uint8_t> values;
        for (size_t i = 0; i < attribute.count(); ++i) {
            const auto zero = [](uint8_t byte) { return byte == 0; };
            const auto first = all.begin() + std::ptrdiff_t(i * size);
            const bool needed = !std::all_of(first, first + std::ptrdiff_t(size), zero);
            if (has_view ? !dice.comes(40) : !needed) continue;
            slots.push_back(uint16_t(i));
            values.insert(values.end(), first, first + std::ptrdiff_t(size));
            std::memset(&base[i * size], 0, size);
        }
        if (has_view || slots.empty())
            accessor["bufferView"] = file_.add_view(base, {{"byteStride", size}});
        if (slots.empty()) return;
        accessor["sparse"] = {
            {"count", slots.size()},
            {"indices", {{"bufferView", file_.add_view_of(slots)}, {"componentType", 5123}}},
            {"values", {{"bufferView", file_.add_view(values)}}}};
    }

    static draco::GeometryAttribute::Type kind_of(const std::string& name) {
        if (name == "POSITION") return draco::GeometryAttribute::POSITION;
        if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
        if (name == "COLOR_0") return draco::GeometryAttribute::COLOR;
        return name.starts_with("TEXCOORD") ? draco::GeometryAttribute::TEX_COORD
                                            : draco::GeometryAttribute::GENERIC;
    }
    static draco::DataType type_of(const Format& format) {
        switch (format.component) {
            case 5120:
                return draco::DT_INT8;
            case 5121:
                return draco::DT_UINT8;
            case 5122:
                return draco::DT_INT16;
            case 5123:
                return draco::DT_UINT16;
            default:
                return draco::DT_FLOAT32;
        }
    }

    TinyGltf& file_;
    size_t fallback_ = 0;  ///< bytes of the buffer that has no data
};

}  // namespace petzval::test
