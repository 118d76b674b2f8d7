// SPDX-License-Identifier: Apache-2.0
#include "apps/live/page_request.h"

#include <algorithm>

#include "apps/request/value_error.h"
#include "apps/setup/input_files.h"
#include "io/base/error.h"
#include "io/file/assets.h"
#include "io/file/read_file.h"

namespace petzval::apps {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const RenderOrder& order) {
    std::vector<fs::path> files;
    std::error_code none;
    for (const io::NamedFile& file : input_files(order.render.scene))
        if (fs::exists(file.path, none)) files.push_back(file.path);
    for (const fs::path& file :
         {fs::path(order.render.moment.shutter_curve), order.render.display.config})
        if (fs::exists(file, none)) files.push_back(file);
    return files;
}

void check_files(const RenderOrder& order, const PageRules& rules) {
    const std::vector<fs::path> known = files_of(rules.start);
    for (const fs::path& file : files_of(order)) {
        const auto in = [&](const fs::path& folder) { return io::lies_within(file, folder); };
        const auto same = [&](const fs::path& one) { return io::same_file(one, file); };
        if (std::ranges::none_of(rules.folders, in) && std::ranges::none_of(known, same))
            throw ValueError(file.string(),
                             "lies outside the folder of the scene; a page may name the files "
                             "there, and those that petzval live was started with");
    }
}

}  // namespace

bool is_for_pages(const RequestField& field) {
    return field.form != FieldForm::Argument && (field.takers & kLive) != 0 &&
           field.part == FieldPart::Picture;
}

PageRules rules_of(RenderOrder start) {
    const fs::path folder = start.render.scene.scene.parent_path();
    PageRules rules{std::move(start), {folder.empty() ? fs::path(".") : folder}};
    for (const char* own : {"glass", "lenses", "spectra"}) try {
            rules.folders.push_back(io::asset(own));
        } catch (const io::InputError&) {  // not installed: whoever needs it will say so
        }
    return rules;
}

nlohmann::json fields_for_page(const RenderOrder& order) {
    nlohmann::json out = nlohmann::json::object();
    for (const FieldTexts& one : fields_of(order))
        if (const auto field = find_field(one.name); field && is_for_pages(*field))
            out[one.name] = one.texts;
    return out;
}

RenderOrder order_of_page(const nlohmann::json& fields, const PageRules& rules) {
    std::vector<FieldTexts> all;
    for (const FieldTexts& one : fields_of(rules.start))
        if (const auto field = find_field(one.name); !is_for_pages(*field)) all.push_back(one);
    for (const auto& [name, texts] : fields.items()) {
        const auto field = find_field(name);
        if (!field || !is_for_pages(*field))
            throw ValueError("⟨" + name + "⟩", "is no field that a page may set");
        const auto is_text = [](const nlohmann::json& one) { return one.is_string(); };
        if (!texts.is_array() || texts.empty() || !std::ranges::all_of(texts, is_text))
            throw ValueError("⟨" + name + "⟩", "must be a list of texts");
        all.push_back({name, texts.get<std::vector<std::string>>()});
    }
    RenderOrder order = order_of(all);
    check_files(order, rules);
    check(order.render);
    return order;
}

}  // namespace petzval::apps
