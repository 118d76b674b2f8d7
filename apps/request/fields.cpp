// SPDX-License-Identifier: Apache-2.0
#include "apps/request/fields.h"

#include <algorithm>

#include "apps/request/field_rows.h"
#include "apps/request/value_error.h"

namespace petzval::apps {

std::vector<RequestField> in_group(const std::string& group, uint8_t takers,
                                   std::vector<RequestField> fields, FieldPart part) {
    for (RequestField& field : fields) {
        field.group = group;
        field.takers = takers;
        field.part = part;
    }
    return fields;
}

std::vector<RequestField> request_fields() {
    std::vector<RequestField> all;
    for (auto fields : {frame_fields(), path_fields(), camera_fields(), run_fields()})
        for (RequestField& field : fields) {
            // What a sample follows from. A view finder shows whole frames.
            if ((field.takers & kRender) && field.part != FieldPart::Files) {
                field.takers |= kTrace;
                if (field.name != "crop") field.takers |= kLive;
            }
            all.push_back(std::move(field));
        }
    return all;
}

std::optional<RequestField> find_field(std::string_view name) {
    for (RequestField& field : request_fields())
        if (field.name == name) return std::move(field);
    return std::nullopt;
}

std::vector<FieldTexts> fields_of(const RenderOrder& order) {
    const RenderOrder nothing;
    std::vector<FieldTexts> out;
    for (const RequestField& field : request_fields())
        if (auto texts = field.texts(order); texts != field.texts(nothing))
            out.push_back({field.name, std::move(texts)});
    return out;
}

RenderOrder order_of(const std::vector<FieldTexts>& all) {
    RenderOrder order;
    const std::vector<RequestField> fields = request_fields();
    for (const FieldTexts& one : all) {
        const auto named = [&](const RequestField& field) { return field.name == one.name; };
        const auto field = std::find_if(fields.begin(), fields.end(), named);
        if (field == fields.end())
            throw ValueError("⟨" + one.name + "⟩", "is no field of a render");
        for (const std::string& text : one.texts) field->set(order, text);
    }
    return order;
}

}  // namespace petzval::apps
