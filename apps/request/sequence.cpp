// SPDX-License-Identifier: Apache-2.0
#include "apps/request/sequence.h"

#include <fmt/format.h>

#include "apps/request/fields.h"
#include "apps/request/file_names.h"
#include "apps/request/value_error.h"

namespace petzval::apps {
namespace {

std::vector<SequenceItem> views(int count) {
    std::vector<SequenceItem> items;
    for (int i = 0; i < count; ++i) {
        const std::string angle_deg = fmt::format("{:.9g}", 360. * i / count);
        items.push_back({i + 1, angle_deg + "°", "orbit", angle_deg});
    }
    return items;
}

std::vector<SequenceItem> swept(const Sweep& sweep) {
    const auto field = find_field(sweep.field);
    if (!field || field->part == FieldPart::Files)
        throw ValueError("⟨sweep⟩", sweep.field +
                                        " is the same for all pictures; sweep what changes the "
                                        "picture");
    std::vector<SequenceItem> items;
    for (const std::string& value : sweep.values)
        items.push_back(
            {static_cast<int>(items.size()) + 1, sweep.field + " " + value, sweep.field, value});
    return items;
}

}  // namespace

std::vector<SequenceItem> items_of(const SequenceRequest& sequence) {
    if (sequence.turntable) return views(*sequence.turntable);
    if (sequence.sweep) return swept(*sequence.sweep);
    std::vector<SequenceItem> items;
    for (const int frame : sequence.frames)
        items.push_back(
            {frame, fmt::format("frame {}", frame), "at", fmt::format("frame:{}", frame)});
    return items;
}

RenderOrder order_of(const SequenceItem& item, const RenderOrder& all, bool several) {
    RenderOrder order = all;
    order.sequence = {};
    order.sequence.sheet = all.sequence.sheet;
    find_field(item.field)->set(order, item.value);
    number_files(order.run, item.number, several);
    return order;
}

}  // namespace petzval::apps
