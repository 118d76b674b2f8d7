// SPDX-License-Identifier: Apache-2.0
// Buffers, bufferViews and accessors: every byte range lies in what it is a range of.
#include <fmt/format.h>

#include "io/gltf/validate/check.h"

namespace petzval {
namespace {

constexpr uint64_t index_buffer_target = 34963;  // ELEMENT_ARRAY_BUFFER

/// The data of a checked bufferView; empty where its buffer has none.
std::span<const uint8_t> view_bytes(const GltfCheck& check, const JsonCursor& view) {
    const auto& buffer = check.source.buffers[view.integer("buffer")];
    if (buffer.empty()) return {};
    return {buffer.data() + view.integer_or("byteOffset", 0), view.integer("byteLength")};
}

void check_stride(const JsonCursor& view, uint64_t length) {
    if (!view.has("byteStride")) return;
    const uint64_t stride = view.integer("byteStride");
    if (stride < 4 || stride > 252 || stride % 4 != 0)
        view.fail("byteStride",
                  fmt::format("must be a multiple of 4 from 4 to 252, but is {}", stride));
    if (stride > length)
        view.fail("byteStride", fmt::format("is {}, more than the byteLength {}", stride, length));
    if (view.integer_or("target", 0) == index_buffer_target)
        view.fail("byteStride", "does not go with the target of an index buffer");
}

void check_buffer_view(const GltfCheck& check, const JsonCursor& view,
                       const std::vector<JsonCursor>& buffers) {
    const size_t buffer = view.required_index("buffer", buffers.size(), "buffer");
    const uint64_t offset = view.integer_or("byteOffset", 0), length = view.integer("byteLength");
    const uint64_t size = buffers[buffer].integer("byteLength");
    if (length == 0) view.fail("byteLength", "must be at least 1");
    if (offset > size || length > size - offset)
        view.fail(fmt::format("ends at byte {}, beyond the {} bytes of buffer {}", offset + length,
                              size, buffer));
    if (check.source.buffers[buffer].empty() && view.extension("EXT_meshopt_compression"))
        view.fail(
            "its data is only in EXT_meshopt_compression, which is not supported; export it "
            "without");
    check_stride(view, length);
    if (view.has("target")) (void)view.integer("target");
}

/// Bytes of `count` elements from byte `offset` of the view on; the last one needs `last` bytes.
/// unit: the component size, of which offsets must be multiples.
std::span<const uint8_t> place_in_view(const GltfCheck& check, const JsonCursor& user,
                                       const JsonCursor& view, uint64_t offset, uint64_t count,
                                       uint64_t stride, uint64_t last, uint64_t unit) {
    const uint64_t length = view.integer("byteLength");
    if ((view.integer_or("byteOffset", 0) + offset) % unit != 0 || offset % unit != 0)
        user.fail("byteOffset", fmt::format("its data must start at a multiple of {} bytes", unit));
    const bool fits = offset <= length && last <= length - offset &&
                      (count - 1) <= (length - offset - last) / stride;
    if (!fits)
        user.fail(
            fmt::format("{} elements of {} bytes from byte {} do not fit into the {} bytes "
                        "of {}",
                        count, stride, offset, length, view.path()));
    const auto bytes = view_bytes(check, view);
    return bytes.empty() ? bytes : bytes.subspan(offset);
}

class AccessorCheck {
  public:
    explicit AccessorCheck(GltfCheck& check)
        : check_(check), views_(check.root.objects("bufferViews")) {}

    GltfAccessor read(const JsonCursor& json) {
        GltfAccessor accessor;
        const uint64_t component_type = json.integer("componentType");
        accessor.component_type = component_type <= 5126 ? int(component_type) : 0;
        accessor.type = json.text("type");
        accessor.count = json.integer("count");
        if (accessor.count == 0) json.fail("count", "must be at least 1");
        accessor.offset = json.integer_or("byteOffset", 0);
        json.check_bool("normalized");
        accessor.normalized = json.value().value("normalized", false);
        if (accessor.normalized &&
            (accessor.component_type == 5126 || accessor.component_type == 5125))
            json.fail("normalized", "only 8- and 16-bit integers can be normalized");
        accessor.view = json.index("bufferView", views_.size(), "bufferView");
        if (component_size(accessor.component_type) > 0)
            accessor.components = component_count(accessor.type);
        if (accessor.components == 0) {
            check_.warn(json, "is of an unknown type");
            return accessor;
        }
        check_bounds(json, size_t(accessor.components));
        find_data(json, accessor);
        if (json.has("sparse")) accessor.sparse = read_sparse(json.object("sparse"), accessor);
        return accessor;
    }

  private:
    static void check_bounds(const JsonCursor& json, size_t components) {
        const double huge = std::numeric_limits<double>::max();
        for (const char* key : {"min", "max"}) (void)json.numbers(key, components, {-huge, huge});
    }

    void find_data(const JsonCursor& json, GltfAccessor& accessor) {
        const size_t size = element_size(accessor.type, accessor.component_type, true);
        accessor.stride = size;
        if (accessor.view) {
            const JsonCursor& view = views_[*accessor.view];
            accessor.stride = view.integer_or("byteStride", size);
            if (accessor.stride < size)
                json.fail(fmt::format("an element takes {} bytes, but {} has a byteStride of {}",
                                      size, view.path(), accessor.stride));
            accessor.bytes =
                place_in_view(check_, json, view, accessor.offset, accessor.count, accessor.stride,
                              element_size(accessor.type, accessor.component_type, false),
                              component_size(accessor.component_type));
        }
        check_.budget.ask(saturating(accessor.count, size), json);
    }

    GltfSparse read_sparse(const JsonCursor& json, const GltfAccessor& accessor) {
        GltfSparse sparse;
        sparse.count = json.integer("count");
        if (sparse.count == 0 || sparse.count > accessor.count)
            json.fail("count", fmt::format("must be from 1 to the accessor's {}, but is {}",
                                           accessor.count, sparse.count));
        const JsonCursor indices = json.object("indices");
        const uint64_t type = indices.integer("componentType");
        if (type != 5121 && type != 5123 && type != 5125)
            indices.fail("componentType", "must be 5121, 5123 or 5125");
        sparse.index_component_type = int(type);
        const size_t index_size = component_size(sparse.index_component_type);
        sparse.indices = packed(indices, sparse.count, index_size, index_size);
        sparse.values = packed(json.object("values"), sparse.count,
                               element_size(accessor.type, accessor.component_type, true),
                               component_size(accessor.component_type));
        check_order(indices, sparse, accessor.count);
        return sparse;
    }

    std::span<const uint8_t> packed(const JsonCursor& json, uint64_t count, size_t size,
                                    size_t unit) const {
        const size_t view = json.required_index("bufferView", views_.size(), "bufferView");
        return place_in_view(check_, json, views_[view], json.integer_or("byteOffset", 0), count,
                             size, size, unit);
    }

    /// Checks that sparse indices increase strictly and stay below the accessor's count.
    static void check_order(const JsonCursor& json, const GltfSparse& sparse, uint64_t limit) {
        if (sparse.indices.empty()) return;
        GltfAccessor list;
        list.component_type = sparse.index_component_type;
        list.components = 1;
        list.count = sparse.count;
        list.stride = component_size(sparse.index_component_type);
        list.bytes = sparse.indices;
        const std::vector<uint32_t> values = read_unsigned(list);
        for (size_t i = 0; i < values.size(); ++i) {
            if (values[i] >= limit)
                json.fail(
                    fmt::format("index {} is beyond the {} elements of the accessor", i, limit));
            if (i > 0 && values[i] <= values[i - 1])
                json.fail(fmt::format("index {} is not more than the one before", i));
        }
    }

    /// Product, at most 2^56: both factors come from the file, and a count may reach 2^53.
    static uint64_t saturating(uint64_t count, size_t size) {
        return count > (uint64_t(1) << 56) / size ? uint64_t(1) << 56 : count * size;
    }

    GltfCheck& check_;
    const std::vector<JsonCursor> views_;
};

}  // namespace

void check_buffers(const GltfCheck& check) {
    for (const JsonCursor& buffer : check.root.objects("buffers"))
        if (buffer.integer("byteLength") == 0) buffer.fail("byteLength", "must be at least 1");
}

void check_buffer_views(const GltfCheck& check) {
    const auto buffers = check.root.objects("buffers");
    for (const JsonCursor& view : check.root.objects("bufferViews"))
        check_buffer_view(check, view, buffers);
}

void check_accessors(GltfCheck& check) {
    AccessorCheck accessors(check);
    for (const JsonCursor& accessor : check.root.objects("accessors"))
        check.accessors.push_back(accessors.read(accessor));
}

}  // namespace petzval
