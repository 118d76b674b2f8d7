// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <set>

#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/gltf/validate/check.h"
#include "io/gltf/validate/extensions.h"

namespace petzval {
namespace {

using nlohmann::json;
using Names = std::set<std::string>;

/// Place where an extension's object may stand: the key that leads to the object, or to the array
/// of objects, that has it; "" is the root, "*Texture" any key with that ending. From the
/// extensions' own texts in Khronos' registry. A name that ends in '_' stands for all that begin
/// so.
struct Home {
    std::string_view extension;
    std::vector<std::string_view> keys;
};

const std::vector<Home>& homes() {
    static const std::vector<Home> table = {{"KHR_lights_punctual", {"", "nodes"}},
                                            {"KHR_texture_transform", {"*Texture"}},
                                            {"KHR_materials_variants", {"", "primitives"}},
                                            {"KHR_materials_", {"materials"}},
                                            {"EXT_texture_webp", {"textures"}},
                                            {"KHR_animation_pointer", {"target"}}};
    return table;
}

bool leads_to(std::string_view home, std::string_view key) {
    return home == "*Texture" ? key.ends_with("Texture") : home == key;
}

bool is_at_home(std::string_view extension, std::string_view key) {
    for (const Home& home : homes()) {
        const bool is_family = home.extension.ends_with('_');
        if (is_family ? !extension.starts_with(home.extension) : extension != home.extension)
            continue;
        for (std::string_view where : home.keys)
            if (leads_to(where, key)) return true;
        return false;
    }
    return true;
}

Names read_names(const JsonCursor& root, const char* key) {
    Names names;
    if (!root.has(key)) return names;
    const json& array = root.value()[key];
    if (!array.is_array()) root.fail(key, "must be an array of strings");
    for (const json& name : array) {
        if (!name.is_string()) root.fail(key, "must be an array of strings");
        names.insert(name.get<std::string>());
    }
    return names;
}

/// Visits every object of the document but those below "extras". The depth of the document is
/// limited, so recursion is safe.
class Walk {
  public:
    Walk(const std::string& file, WarningLog& warnings) : file_(file), warnings_(warnings) {}

    void visit(const json& value, std::string_view key, const std::string& path) const {
        if (value.is_object()) check(value, key, path);
        if (!value.is_structured()) return;
        for (const auto& [name, child] : value.items()) {
            if (!child.is_structured() || (value.is_object() && name == "extras")) continue;
            visit(child, value.is_array() ? key : name, child_path(path, name));
        }
    }

  private:
    static std::string child_path(const std::string& path, const std::string& name) {
        return path + "/" + printable(name);
    }

    void check(const json& object, std::string_view key, const std::string& path) const {
        const auto at = object.find("extensions");
        if (at == object.end()) return;
        const std::string place = child_path(path, "extensions");
        if (!at->is_object()) fail(place, "must be an object");
        for (const auto& [name, content] : at->items()) {
            const std::string where = child_path(place, name);
            if (!content.is_object()) fail(where, "must be an object");
            if (!is_at_home(name, key))
                warnings_.push_back(where + ": stands where this extension has no meaning");
        }
    }

    [[noreturn]] void fail(const std::string& path, const char* message) const {
        throw InputError(file_, path, message);
    }

    const std::string& file_;
    WarningLog& warnings_;
};

}  // namespace

void check_extensions(GltfCheck& check) {
    const Names used = read_names(check.root, "extensionsUsed");
    const Names required = read_names(check.root, "extensionsRequired");
    for (const std::string& name : required) {
        if (!is_supported_gltf_extension(name))
            check.root.fail("extensionsRequired",
                            fmt::format("the file requires the extension {}, which is not "
                                        "supported; export it without",
                                        printable(name)));
    }
    for (const std::string& name : used)
        if (!is_supported_gltf_extension(name))
            check.source.warnings.push_back("/extensionsUsed: " + printable(name) +
                                            " is not supported and is ignored");
    const std::string file = check.source.path.string();
    Walk(file, check.source.warnings).visit(check.root.value(), "", "");
}

}  // namespace petzval
