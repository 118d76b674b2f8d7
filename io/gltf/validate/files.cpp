// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "io/base/error.h"
#include "io/base/json_cursor.h"
#include "io/base/json_parse.h"
#include "io/base/nearest.h"
#include "io/base/uri.h"
#include "io/file/read_file.h"
#include "io/gltf/schema/extensions.h"
#include "io/spectra/spectra.h"

namespace petzval::io {
namespace {

using Bytes = std::vector<uint8_t>;
using MimeTypes = std::vector<std::string_view>;

/// Bytes of a profile's table over those of its text, beside the text: "1 " may become four floats.
constexpr uint64_t kProfileGrowth = 8;

bool is_link_loop(const std::filesystem::path& path) {
    std::error_code error;
    static_cast<void>(std::filesystem::status(path, error));
    return error == std::errc::too_many_symbolic_link_levels;
}

/// Reads the bytes that a "uri" names, and counts them in the budget.
class Fetcher {
  public:
    Fetcher(GltfSource& source, GltfBudget& budget) : source_(source), budget_(budget) {}

    /// Bytes behind the "uri" of owner, or what key says. mime_types: those that a data URI may
    /// declare; empty: any.
    Bytes fetch(const JsonCursor& owner, const MimeTypes& mime_types, const char* key = "uri") {
        const std::string uri = owner.text(key);
        return is_data_uri(uri) ? from_data(owner, uri, mime_types)
                                : from_file(owner, uri, nullptr, key);
    }

    /// Bytes likewise of what a scene can be shown without; none, and a warning that it is left
    /// out, where its file does not exist: models are passed on without their textures. what: "the
    /// texture" ...
    Bytes fetch_if_there(const JsonCursor& owner, const char* what) {
        const std::string uri = owner.text("uri");
        return is_data_uri(uri) ? from_data(owner, uri, {}) : from_file(owner, uri, what);
    }

  private:
    Bytes from_data(const JsonCursor& owner, const std::string& uri, const MimeTypes& types) {
        auto data = parse_data_uri(uri);
        if (!data) owner.fail("uri", "is not a valid data URI; it must hold base64");
        if (!types.empty() && std::find(types.begin(), types.end(), data->mime_type) == types.end())
            source_.warnings.add(owner.path_of("uri"),
                                 "holds \"{}\" instead of {}; it is read all the same",
                                 printable(data->mime_type), types.front());
        return std::move(data->bytes);
    }

    Bytes from_file(const JsonCursor& owner, const std::string& uri,
                    const char* dispensable = nullptr, const char* key = "uri") {
        const auto path = relative_path(uri);
        if (!path && dispensable) {
            source_.warnings.add(owner.path_of("uri"),
                                 "\"{}\" is not a relative path to a file; {} is left out",
                                 printable(uri), dispensable);
            return {};
        }
        if (!path)
            owner.fail(key,
                       "\"{}\" is not a relative path to a file; network and "
                       "absolute addresses are not read",
                       printable(uri));
        const std::filesystem::path folder = source_.path.parent_path(), full = folder / *path;
        if (source_.scope == FileScope::Confined && !lies_within(full, folder))
            owner.fail(key, "\"{}\" {}", printable(*path),
                       is_link_loop(full) ? "is a link that leads back to itself"
                                          : "lies outside the folder of the scene, and "
                                            "⟨confine⟩ allows no file there");
        FileBytes file = read_file(full);
        if (dispensable && file.error == "no such file") {
            source_.warnings.add(owner.path_of("uri"), "there is no file \"{}\"; {} is left out",
                                 printable(*path), dispensable);
            return {};
        }
        if (!file.error.empty()) owner.fail(key, "\"{}\": {}", printable(*path), file.error);
        if (!times_read_.contains(*path)) source_.files.push_back(full);
        count(*path, file.bytes, owner);
        return std::move(file.bytes);
    }

    void count(const std::string& path, const Bytes& bytes, const JsonCursor& owner) {
        if (++times_read_[path] > 1) return budget_.ask(bytes.size(), owner);
        budget_.add_owned(bytes.size());
        source_.hash = fnv1a(bytes, source_.hash);
    }

    GltfSource& source_;
    GltfBudget& budget_;
    std::map<std::string, int> times_read_;
};

/// The binary chunk is padded to four bytes, so it may be longer than the buffer.
Bytes buffer_from_chunk(const JsonCursor& buffer, std::span<const uint8_t> bin) {
    const uint64_t length =
        std::min<uint64_t>(buffer.integer_or("byteLength", bin.size()), bin.size());
    return {bin.begin(), bin.begin() + ptrdiff_t(length)};
}

/// Whether a buffer stands only for what compressed bufferViews have, so that its bytes, if there
/// are any, need not be read.
bool is_fallback(const JsonCursor& buffer) {
    const auto meshopt = meshopt_extension(buffer);
    if (!meshopt || !meshopt->has("fallback")) return false;
    meshopt->check_bool("fallback");
    return meshopt->value()["fallback"];
}

/// Sets a byteLength that is absent or too great to what is there: bufferViews that lie beyond it
/// are found later.
void mend_length(GltfSource& source, size_t index, const JsonCursor& buffer, size_t size) {
    const uint64_t length = buffer.integer_or("byteLength", size);
    if (buffer.has("byteLength") && length <= size) return;
    if (buffer.has("byteLength"))
        source.warnings.add(buffer.path(), "byteLength is {}, but there are {} bytes", length,
                            size);
    else
        source.warnings.add(buffer.path(), "has no byteLength; there are {} bytes", size);
    source.json["buffers"][index]["byteLength"] = size;
}

Bytes bytes_from_view(GltfSource& source, const std::vector<JsonCursor>& views,
                      const JsonCursor& owner, GltfBudget& budget) {
    const JsonCursor& view = views[owner.required_index("bufferView", views.size(), "bufferView")];
    const Bytes& buffer = source.buffers[view.integer("buffer")];
    if (buffer.empty()) {
        source.warnings.add(owner.path(), "lies in a buffer without data; left empty");
        return {};
    }
    const uint64_t offset = view.integer_or("byteOffset", 0), length = view.integer("byteLength");
    budget.ask(length, owner);
    return {buffer.begin() + ptrdiff_t(offset), buffer.begin() + ptrdiff_t(offset + length)};
}

}  // namespace

void read_buffers(GltfSource& source, const GltfContainer& container, GltfBudget& budget) {
    const std::string file = source.path.string();
    Fetcher fetcher(source, budget);
    for (const JsonCursor& buffer : JsonCursor(source.json, file).objects("buffers")) {
        const bool first = source.buffers.empty();
        if (is_fallback(buffer)) {
            source.buffers.emplace_back();
            (void)buffer.integer("byteLength");
            continue;
        }
        if (buffer.has("uri"))
            source.buffers.push_back(
                fetcher.fetch(buffer, {"application/octet-stream", "application/gltf-buffer"}));
        else if (first && container.bin)
            source.buffers.push_back(buffer_from_chunk(buffer, *container.bin));
        else if (first && container.binary)
            buffer.fail("has no uri, and the file has no BIN chunk; the file is cut short");
        else {
            source.buffers.emplace_back();
            source.warnings.add(buffer.path(), "has no data; reads as zeros");
            (void)buffer.integer("byteLength");
            continue;
        }
        mend_length(source, source.buffers.size() - 1, buffer, source.buffers.back().size());
    }
}

void read_images(GltfSource& source, const GltfUse& use, GltfBudget& budget) {
    const std::string file = source.path.string();
    const JsonCursor root(source.json, file);
    const auto views = root.objects("bufferViews");
    Fetcher fetcher(source, budget);
    for (const JsonCursor& image : root.objects("images")) {
        const bool used = use.images[source.images.size()];
        source.images.emplace_back();
        if (!image.has("uri") && !image.has("bufferView")) {
            source.warnings.add(image.path(), "has neither a uri nor a bufferView");
            continue;
        }
        try {
            source.images.back() = image.has("uri") ? fetcher.fetch_if_there(image, "the texture")
                                                    : bytes_from_view(source, views, image, budget);
        } catch (const InputError&) {
            if (used) throw;
            source.warnings.add(image.path(), "is broken, but nothing needs it");
        }
    }
}

void read_light_profiles(GltfSource& source, GltfBudget& budget) {
    const std::string file = source.path.string();
    const JsonCursor root(source.json, file);
    const auto extension = root.extension("EXT_lights_ies");
    if (!extension) return;
    const auto views = root.objects("bufferViews");
    Fetcher fetcher(source, budget);
    for (const JsonCursor& light : extension->objects("lights")) {
        if (!light.has("uri") && !light.has("bufferView"))
            light.fail("has neither a uri nor a bufferView");
        source.light_profiles.push_back(light.has("uri")
                                            ? fetcher.fetch_if_there(light, "its light")
                                            : bytes_from_view(source, views, light, budget));
        budget.ask(source.light_profiles.back().size() * kProfileGrowth, light);
    }
}

void fetch_reflectance(GltfSource& source, const JsonCursor& extras, GltfBudget& budget) {
    if (!extras.has("reflectance")) return;
    const std::string name = extras.text("reflectance");
    if (source.reflectances.contains(name)) return;
    auto found = find_reflectance(name);
    if (!found) {
        const auto path = relative_path(name);
        if (!path || path->find_first_of("./") == path->npos)
            extras.fail("reflectance", "\"{}\" is neither a name nor a relative path to a file{}",
                        printable(name),
                        did_you_mean_or("the names are", name, reflectance_names()));
        const Bytes bytes = Fetcher(source, budget).fetch(extras, {}, "reflectance");
        found = read_reflectance(source.path.parent_path() / *path, bytes, name);
    }
    source.reflectances.emplace(name, *std::move(found));
}

}  // namespace petzval::io
