// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/mend/mend_property.h"

#include <algorithm>

#include "io/base/ascii.h"
#include "io/base/json_parse.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// Fills up a list of numbers that is one short, and cuts off those that are too many.
void mend_length(const JsonEditor& owner, const char* key, size_t count, double last) {
    json* numbers = owner.array(key);
    if (!numbers || numbers->size() == count || numbers->size() + 1 < count) return;
    owner.warn(key, fmt::format("holds {} numbers; it must hold {}", numbers->size(), count));
    while (numbers->size() > count) numbers->erase(numbers->end() - 1);
    if (numbers->size() < count) numbers->push_back(last);
}

/// Mends alphaMode, the one text of which all values are known.
void mend_word(const JsonEditor& owner, const char* key) {
    json* value = owner.find(key);
    if (!value || !value->is_string()) return;
    const std::string text = value->get<std::string>();
    for (const char* known : {"OPAQUE", "MASK", "BLEND"}) {
        if (text == known) return;
        if (lower(text) != lower(known)) continue;
        owner.warn(key, fmt::format("is \"{}\"; {} is taken", printable(text), known));
        *value = known;
        return;
    }
    owner.warn(key, fmt::format("is \"{}\", which is unknown; OPAQUE is taken", printable(text)));
    *value = "OPAQUE";
}

void mend_bool(const JsonEditor& owner, const char* key) {
    json* value = owner.find(key);
    if (!value || !value->is_number() || (*value != 0 && *value != 1)) return;
    owner.warn(key, "is a number; 0 is taken as false, 1 as true");
    *value = *value == 1;
}

/// Light may be as bright as the file says, although the factor should end at 1: nobody writes 5
/// who means 1.
void mend_emission(const JsonEditor& owner, const char* key) {
    json* factor = owner.array(key);
    if (!factor) return;
    const bool brighter = std::any_of(factor->begin(), factor->end(), [](const json& c) {
        return c.is_number() && c.get<double>() > 1.002;
    });
    if (brighter)
        owner.warn(key,
                   "is above 1; it is taken as it stands, "
                   "KHR_materials_emissive_strength should say so");
    else
        owner.clamp_each(key, {0, 1});
}

}  // namespace

void mend_property(const JsonEditor& owner, const GltfProperty& property) {
    const auto& [place, key, kind, preset, range, mending] = property;
    if (kind == PropertyKind::Word) return mend_word(owner, key);
    if (kind == PropertyKind::Yes || kind == PropertyKind::Switch) return mend_bool(owner, key);
    if (mending == Mending::Keep || range.low < -1e30) return;
    if (kind == PropertyKind::Number) {
        const json* value = owner.find(key);
        const double number = value && value->is_number() ? value->get<double>() : 1;
        if (mending == Mending::DropUnlessPositive && number <= 0)
            owner.drop(key, fmt::format("is {}; nothing is absorbed", number));
        else if (mending == Mending::Clamp || (mending == Mending::ClampButZero && number != 0))
            owner.clamp(key, range);
    } else if (property.width() > 0) {
        const bool emits = mending == Mending::Emission;
        mend_length(owner, key, property.width(), emits ? 0 : 1);
        owner.clamp_each(key, range);
        if (emits) mend_emission(owner, key);
    }
}

}  // namespace petzval::io
