// SPDX-License-Identifier: Apache-2.0
// The asset's version, and the lists of extensions.
#include <fmt/format.h>

#include <set>

#include "io/base/json_parse.h"
#include "io/gltf/mend/mend.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// A version that begins with 2 but is not "2.x" becomes "2.0": all of glTF 2 that there is.
void mend_version(const JsonEditor& asset) {
    json* version = asset.find("version");
    if (!version) return;
    const bool number = version->is_number() && *version == 2;
    const std::string text = version->is_string() ? version->get<std::string>() : "";
    const bool two = text == "2" || (text.starts_with("2.") &&
                                     text.find_first_not_of("0123456789", 2) != text.npos);
    if (!number && !two && text != "2.") return;
    asset.warn("version", fmt::format("is {}; it is taken as \"2.0\"", printable(version->dump())));
    *version = "2.0";
}

void mend_least_version(const JsonEditor& asset) {
    const json* least = asset.find("minVersion");
    if (!least || (least->is_string() && least->get<std::string>().starts_with("2."))) return;
    asset.drop("minVersion",
               fmt::format("is {}, no version of glTF 2; it is ignored", printable(least->dump())));
}

using Names = std::set<std::string>;

/// The names in a list, each once; what is no list of texts is left to the checks.
std::optional<Names> names_in(const JsonEditor& root, const char* key) {
    json* list = root.find(key);
    if (!list) return Names();
    if (!list->is_array()) return std::nullopt;
    Names names;
    json once = json::array();
    for (const json& name : *list) {
        if (!name.is_string()) return std::nullopt;
        if (names.insert(name.get<std::string>()).second) once.push_back(name);
    }
    *list = std::move(once);
    return names;
}

/// Collects the extensions that objects have, except those in "extras", and mends what has no
/// content.
class Collector {
  public:
    explicit Collector(const JsonEditor& root) : root_(root) {}

    void visit(json& value) {
        if (value.is_object()) {
            const auto at = value.find("extensions");
            if (at != value.end() && at->is_object()) collect(*at);
        }
        if (value.is_array()) {
            for (json& child : value)
                if (child.is_structured()) visit(child);
            return;
        }
        for (auto& [key, child] : value.items())
            if (child.is_structured() && key != "extras") visit(child);
    }
    [[nodiscard]] const Names& found() const { return found_; }

  private:
    void collect(json& extensions) {
        for (auto& [name, content] : extensions.items()) {
            found_.insert(name);
            const bool empty = content == true || (content.is_array() && content.empty());
            if (!empty) continue;
            root_.warn(
                fmt::format("an extension {} is {} instead of an object; an empty one is taken",
                            printable(name), content.dump()));
            content = json::object();
        }
    }

    const JsonEditor& root_;
    Names found_;
};

void declare(const JsonEditor& root, Names& used, const std::string& name, const char* why) {
    if (!used.insert(name).second) return;
    root.value()["extensionsUsed"].push_back(name);
    root.warn("extensionsUsed",
              fmt::format("does not list {}, which {}; it is added", printable(name), why));
}

}  // namespace

void mend_header(const JsonEditor& root) {
    if (const auto asset = root.find_object("asset")) {
        mend_version(*asset);
        mend_least_version(*asset);
    }
    auto used = names_in(root, "extensionsUsed");
    const auto required = names_in(root, "extensionsRequired");
    if (!used || !required) return;
    for (const std::string& name : *required) declare(root, *used, name, "the file requires");
    Collector collector(root);
    collector.visit(root.value());
    for (const std::string& name : collector.found()) declare(root, *used, name, "an object has");
}

}  // namespace petzval::io
