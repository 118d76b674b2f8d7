// SPDX-License-Identifier: Apache-2.0
// Buffers, bufferViews and accessors: every byte range lies in what it is a range of.
#include <fmt/format.h>

#include <algorithm>

#include "io/base/error.h"
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

/// The data of a checked bufferView; empty where its buffer has none.
std::span<const uint8_t> view_bytes(const GltfCheck& check, const JsonCursor& view) {
    const auto& buffer = check.source.buffers[view.integer("buffer")];
    if (buffer.empty()) return {};
    return {buffer.data() + view.integer_or("byteOffset", 0), view.integer("byteLength")};
}

/// Ends a bufferView where its buffer ends: exporters round lengths up. What does not lie in it is
/// missed by those that need it.
void fit(GltfCheck& check, size_t index, const JsonCursor& view, uint64_t size) {
    const uint64_t offset = view.integer_or("byteOffset", 0), length = view.integer("byteLength");
    if (offset <= size && length <= size - offset) return;
    const uint64_t start = std::min(offset, size);
    check.warn(view, fmt::format("ends at byte {}, beyond the {} bytes of buffer {}; it ends there",
                                 offset + length, size, view.integer("buffer")));
    check.source.json["bufferViews"][index]["byteOffset"] = start;
    check.source.json["bufferViews"][index]["byteLength"] = size - start;
}

void check_buffer_view(GltfCheck& check, size_t index, const JsonCursor& view,
                       const std::vector<JsonCursor>& buffers) {
    const size_t buffer = view.required_index("buffer", buffers.size(), "buffer");
    fit(check, index, view, buffers[buffer].integer("byteLength"));
    (void)view.integer_or("byteStride", 4);
}

/// Bytes of `count` elements from byte `offset` of the view on; the last one needs `last` bytes.
/// They need not be aligned: that is for graphics cards.
std::span<const uint8_t> place_in_view(const GltfCheck& check, const JsonCursor& user,
                                       const JsonCursor& view, uint64_t offset, uint64_t count,
                                       uint64_t stride, uint64_t last) {
    const uint64_t length = view.integer("byteLength");
    const bool fits = offset <= length && last <= length - offset &&
                      (count - 1) <= (length - offset - last) / stride;
    if (!fits)
        user.fail(
            fmt::format("{} elements of {} bytes from byte {} do not fit into the {} bytes of {}",
                        count, stride, offset, length, view.path()));
    const auto bytes = view_bytes(check, view);
    return bytes.empty() ? bytes : bytes.subspan(offset);
}

class AccessorCheck {
  public:
    explicit AccessorCheck(GltfCheck& check)
        : check_(check), views_(check.root.objects("bufferViews")) {}

    GltfAccessor read(const JsonCursor& cursor) {
        GltfAccessor accessor;
        const uint64_t component_type = cursor.integer("componentType");
        accessor.component_type = component_type <= 5126 ? int(component_type) : 0;
        accessor.type = cursor.text("type");
        accessor.count = cursor.integer("count");
        if (accessor.count == 0) cursor.fail("count", "must be at least 1");
        accessor.offset = cursor.integer_or("byteOffset", 0);
        cursor.check_bool("normalized");
        accessor.normalized = cursor.value().value("normalized", false);
        if (accessor.normalized &&
            (accessor.component_type == 5126 || accessor.component_type == 5125))
            cursor.fail("normalized", "only 8- and 16-bit integers can be normalized");
        accessor.view = cursor.index("bufferView", views_.size(), "bufferView");
        if (component_size(accessor.component_type) > 0)
            accessor.components = component_count(accessor.type);
        if (accessor.components == 0) {
            check_.warn(cursor, "is of an unknown type");
            return accessor;
        }
        find_data(cursor, accessor);
        if (cursor.has("sparse")) accessor.sparse = read_sparse(cursor.object("sparse"), accessor);
        return accessor;
    }

  private:
    void find_data(const JsonCursor& cursor, GltfAccessor& accessor) {
        const size_t size = element_size(accessor.type, accessor.component_type, true);
        accessor.stride = size;
        if (accessor.view) {
            const JsonCursor& view = views_[*accessor.view];
            accessor.stride = view.integer_or("byteStride", size);
            if (accessor.stride < size)
                cursor.fail(fmt::format("an element takes {} bytes, but {} has a byteStride of {}",
                                        size, view.path(), accessor.stride));
            accessor.bytes = place_in_view(
                check_, cursor, view, accessor.offset, accessor.count, accessor.stride,
                element_size(accessor.type, accessor.component_type, false));
        }
        check_.budget.ask(saturating(accessor.count, size), cursor);
    }

    GltfSparse read_sparse(const JsonCursor& cursor, const GltfAccessor& accessor) {
        GltfSparse sparse;
        sparse.count = cursor.integer("count");
        if (sparse.count == 0 || sparse.count > accessor.count)
            cursor.fail("count", "must be from 1 to the accessor's {}, but is {}", accessor.count,
                        sparse.count);
        const JsonCursor indices = cursor.object("indices");
        const uint64_t type = indices.integer("componentType");
        if (type != 5121 && type != 5123 && type != 5125)
            indices.fail("componentType", "must be 5121, 5123 or 5125");
        sparse.index_component_type = int(type);
        sparse.indices = packed(indices, sparse.count, component_size(sparse.index_component_type));
        sparse.values = packed(cursor.object("values"), sparse.count,
                               element_size(accessor.type, accessor.component_type, true));
        check_indices(indices, sparse, accessor.count);
        return sparse;
    }

    std::span<const uint8_t> packed(const JsonCursor& cursor, uint64_t count, size_t size) const {
        const size_t view = cursor.required_index("bufferView", views_.size(), "bufferView");
        return place_in_view(check_, cursor, views_[view], cursor.integer_or("byteOffset", 0),
                             count, size, size);
    }

    /// Checks that sparse indices stay below the accessor's count. Those that do not increase are
    /// read all the same: the last one holds.
    static void check_indices(const JsonCursor& cursor, const GltfSparse& sparse, uint64_t limit) {
        if (sparse.indices.empty()) return;
        const std::vector<uint32_t> values = indices_of(sparse);
        for (size_t i = 0; i < values.size(); ++i)
            if (values[i] >= limit)
                cursor.fail(
                    fmt::format("index {} is beyond the {} elements of the accessor", i, limit));
    }

    /// Product, at most 2^56: both factors come from the file, and a count may reach 2^53.
    static uint64_t saturating(uint64_t count, size_t size) {
        return count > (uint64_t(1) << 56) / size ? uint64_t(1) << 56 : count * size;
    }

    GltfCheck& check_;
    const std::vector<JsonCursor> views_;
};

/// Whether an accessor is that of an empty mesh, as exporters write them.
bool is_empty(const JsonCursor& accessor) {
    const auto count = accessor.value().find("count");
    return count != accessor.value().end() && *count == 0;
}

}  // namespace

// Objects that nothing needs are replaced where they are broken.
void check_buffer_views(GltfCheck& check) {
    const auto views = check.root.objects("bufferViews"), buffers = check.root.objects("buffers");
    for (size_t i = 0; i < views.size(); ++i) try {
            check_buffer_view(check, i, views[i], buffers);
        } catch (const InputError&) {
            if (check.use.views[i]) throw;
            check.warn(views[i], "is broken, but nothing needs it");
            check.source.json["bufferViews"][i] = {{"buffer", 0}, {"byteLength", 0}};
        }
}

void check_accessors(GltfCheck& check) {
    AccessorCheck accessors(check);
    check.accessors.clear();
    const auto cursors = check.root.objects("accessors");
    for (size_t i = 0; i < cursors.size(); ++i) try {
            check.accessors.push_back(accessors.read(cursors[i]));
        } catch (const InputError&) {
            if (check.use.accessors[i]) throw;
            check.warn(cursors[i], is_empty(cursors[i])
                                       ? "holds no elements; what names it shows nothing"
                                       : "is broken, but nothing needs it");
            check.source.json["accessors"][i] = {
                {"componentType", 5121}, {"type", "SCALAR"}, {"count", 1}};
            check.accessors.emplace_back();
        }
}

}  // namespace petzval::io
