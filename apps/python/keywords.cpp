// SPDX-License-Identifier: Apache-2.0
#include "apps/python/keywords.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>

#include "apps/python/bindings.h"
#include "apps/request/fields.h"
#include "apps/request/option_text.h"
#include "apps/request/value_error.h"
#include "io/base/nearest.h"

namespace petzval::apps {
namespace {

namespace py = pybind11;

// Short names are usual on a command line; two are of what Python has objects for.
std::string keyword_of(std::string name) {
    constexpr std::array<std::array<const char*, 2>, 4> kOther{{{"spp", "samples"},
                                                                {"aov", "layers"},
                                                                {"scene", "scene_name"},
                                                                {"camera", "camera_name"}}};
    for (const auto& [option, keyword] : kOther)
        if (name == option) return keyword;
    std::ranges::replace(name, '-', '_');
    return name;
}

// What is written, printed and made one after another is a Python program's own; threads are a
// session's.
bool is_keyword(const RequestField& field) {
    return field.name != "threads" && field.part != FieldPart::Files &&
           field.form != FieldForm::Argument && (field.takers & kRender) != 0;
}

// What takes a field: what it says of a camera, of a scene, or of a render alone.
const char* owner_of(const RequestField& field) {
    if (field.group == "Camera" || field.group == "Lens") return "camera";
    return (field.takers & kInfo) != 0 || field.group == "Light" ? "scene" : "render";
}

const char* kind_of(const RequestField& field) {
    if (field.form == FieldForm::Switch) return "SWITCH";
    if (field.form == FieldForm::List) return "LIST";
    return field.value.c_str();
}

py::list described_fields() {
    py::list all;
    for (const RequestField& field : request_fields())
        if (is_keyword(field)) {
            py::dict one;
            one["keyword"] = keyword_of(field.name);
            one["kind"] = kind_of(field);
            one["owner"] = owner_of(field);
            one["takers"] = std::string((field.takers & kPlan) != 0 ? "plan " : "") +
                            ((field.takers & kChart) != 0 ? "chart" : "");
            one["between"] = std::string(1, field.between);
            one["help"] = as_keywords(field.help);
            all.append(one);
        }
    return all;
}

}  // namespace

RenderOrder order_of(const Keywords& keywords) {
    RenderOrder order;
    const std::vector<RequestField> fields = request_fields();
    for (const auto& [keyword, text] : keywords) {
        const auto called = [&, word = keyword](const RequestField& field) {
            return keyword_of(field.name) == word;
        };
        const auto field = std::ranges::find_if(fields, called);
        if (field == fields.end()) {
            std::vector<std::string> known;
            for (const RequestField& one : fields) known.push_back(keyword_of(one.name));
            throw ValueError(keyword, "is no field" + io::did_you_mean(keyword, known));
        }
        field->set(order, text);
    }
    return order;
}

Keywords keywords_of(const RenderOrder& order) {
    Keywords all;
    for (const FieldTexts& one : fields_of(order))
        for (const std::string& text : one.texts) all.emplace_back(keyword_of(one.name), text);
    return all;
}

std::string as_keywords(const std::string& message) {
    return with_names(message, [](const std::string& name, bool has_value) {
        return keyword_of(name) + (has_value ? "=" : "");
    });
}

void bind_fields(py::module_& module) {
    module.def("fields", described_fields);
    module.def("check_fields", [](const Keywords& keywords) { (void)order_of(keywords); });
}

}  // namespace petzval::apps
