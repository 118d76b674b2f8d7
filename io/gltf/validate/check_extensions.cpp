// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <set>

#include "io/base/error.h"
#include "io/base/json_parse.h"
#include "io/gltf/schema/extensions.h"
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

using nlohmann::json;
using Names = std::set<std::string>;

bool leads_to(std::string_view place, std::string_view key) {
    if (place == "root") return key.empty();
    return place == "*Texture" ? key.ends_with("Texture") : place == key;
}

/// Whether an object to which that key leads may have the extension.
bool is_at_home(const GltfExtension& extension, std::string_view key) {
    std::string_view places = extension.places;
    if (places.empty()) return true;
    while (!places.empty()) {
        const size_t end = std::min(places.find(' '), places.size());
        if (leads_to(places.substr(0, end), key)) return true;
        places.remove_prefix(std::min(end + 1, places.size()));
    }
    return false;
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

/// Visits every object of the document but those below "extras", and counts those that have an
/// extension. The depth of the document is limited, so recursion is safe.
class Walk {
  public:
    Walk(const std::string& file, WarningLog& warnings) : file_(file), warnings_(warnings) {}

    [[nodiscard]] uint64_t objects(const std::string& extension) const {
        const auto at = objects_.find(extension);
        return at == objects_.end() ? 0 : at->second;
    }

    void visit(const json& value, std::string_view key, const std::string& path) {
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

    void check(const json& object, std::string_view key, const std::string& path) {
        const auto at = object.find("extensions");
        if (at == object.end()) return;
        const std::string place = child_path(path, "extensions");
        if (!at->is_object()) fail(place, "must be an object");
        for (const auto& [name, content] : at->items()) {
            const std::string where = child_path(place, name);
            if (!content.is_object()) fail(where, "must be an object");
            ++objects_[name];
            const GltfExtension* known = find_gltf_extension(name);
            if (known && !is_at_home(*known, key))
                warnings_.push_back(where + ": stands where this extension has no meaning");
        }
    }

    [[noreturn]] void fail(const std::string& path, const char* message) const {
        throw InputError(file_, path, message);
    }

    const std::string& file_;
    WarningLog& warnings_;
    std::map<std::string, uint64_t> objects_;
};

ExtensionInFile describe(const std::string& name, uint64_t objects, bool required) {
    const GltfExtension* known = find_gltf_extension(name);
    if (known) {
        ExtensionInFile out{name, known->use, std::string(known->effect), objects, required};
        if (out.refused()) out.effect = gltf_extension_advice(name);
        return out;
    }
    return {name, required ? ExtensionUse::Needed : ExtensionUse::Ignored,
            "this program does not know it", objects, required};
}

void warn(const ExtensionInFile& extension, WarningLog& warnings) {
    const std::string name = "/extensionsUsed: " + printable(extension.name);
    if (!find_gltf_extension(extension.name))
        warnings.push_back(name + " is not supported and is ignored");
    else if (extension.objects == 0 && !extension.required)
        return;  // declared by habit: nothing has it
    else if (extension.use == ExtensionUse::Approximated)
        warnings.push_back(name + " is approximated: " + extension.effect);
    else if (extension.use == ExtensionUse::Ignored || extension.use == ExtensionUse::Needed)
        warnings.push_back(name + " is ignored: " + extension.effect);
}

}  // namespace

void list_extensions(GltfCheck& check) {
    const Names used = read_names(check.root, "extensionsUsed");
    const Names required = read_names(check.root, "extensionsRequired");
    const std::string file = check.source.path.string();
    Walk walk(file, check.source.warnings);
    walk.visit(check.root.value(), "", "");
    for (const std::string& name : used) {
        const auto extension = describe(name, walk.objects(name), required.contains(name));
        warn(extension, check.source.warnings);
        check.source.extensions.push_back(extension);
    }
}

void check_extensions(const GltfCheck& check) {
    for (const ExtensionInFile& extension : check.source.extensions)
        if (extension.refused())
            check.root.fail("extensionsRequired",
                            "the file requires the extension {}, which is not supported; {}",
                            printable(extension.name), gltf_extension_advice(extension.name));
}

}  // namespace petzval::io
