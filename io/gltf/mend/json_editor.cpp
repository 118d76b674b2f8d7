// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/mend/json_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/base/json_parse.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// Distance from a bound, relative to it where it is above 1, that is an exporter's rounding: half
/// of the step of eight bits is 0.002.
constexpr double kRounding = 0.002;

std::string words_of(Range range) {
    if (range.high >= std::numeric_limits<float>::max())
        return fmt::format("not be below {}", range.low);
    return fmt::format("be from {} to {}", range.low, range.high);
}

}  // namespace

std::string JsonEditor::path() const {
    std::string path = up_ ? up_->path() : std::string();
    if (is_extension_) path += "/extensions";
    if (!key_.empty()) path += fmt::format("/{}", printable(key_));
    if (index_) path += fmt::format("/{}", *index_);
    return path;
}

void JsonEditor::warn(std::string_view key, const std::string& message) const {
    warnings_->push_back(fmt::format("{}/{}: {}", path(), printable(key), message));
}

void JsonEditor::warn(const std::string& message) const {
    const std::string place = path();
    warnings_->push_back(place.empty() ? message : fmt::format("{}: {}", place, message));
}

json* JsonEditor::find(const char* key) const {
    const auto at = value_->find(key);
    return at == value_->end() ? nullptr : &*at;
}

json* JsonEditor::array(const char* key) const {
    json* at = find(key);
    return at && at->is_array() ? at : nullptr;
}

std::optional<uint64_t> JsonEditor::integer(const char* key) const {
    const json* at = find(key);
    if (!at || !at->is_number_integer() || at->get<double>() < 0) return std::nullopt;
    return at->get<uint64_t>();
}

std::optional<JsonEditor> JsonEditor::find_object(const char* key) const {
    json* at = find(key);
    if (!at || !at->is_object()) return std::nullopt;
    return JsonEditor(*at, *warnings_, this, key, {});
}

std::optional<JsonEditor> JsonEditor::extension(const char* name) const {
    json* extensions = find("extensions");
    if (!extensions || !extensions->is_object()) return std::nullopt;
    const auto at = extensions->find(name);
    if (at == extensions->end() || !at->is_object()) return std::nullopt;
    JsonEditor editor(*at, *warnings_, this, at.key(), {});
    editor.is_extension_ = true;
    return editor;
}

void JsonEditor::drop(const char* key, const std::string& message) const {
    if (value_->erase(key) > 0) warn(key, message);
}

void JsonEditor::clamp(const char* key, Range range) const {
    if (json* at = find(key)) clamp(*at, key, range);
}

void JsonEditor::clamp_each(const char* key, Range range) const {
    json* numbers = array(key);
    for (size_t i = 0; numbers && i < numbers->size(); ++i)
        clamp((*numbers)[i], fmt::format("{}/{}", key, i), range);
}

void JsonEditor::clamp(json& number, const std::string& key, Range range) const {
    if (!number.is_number()) return;
    const double value = number.get<double>(), bound = std::clamp(value, range.low, range.high);
    if (value == bound) return;
    if (std::abs(value - bound) > kRounding * std::max(1.0, std::abs(bound)))
        warn(key,
             std::abs(value) > std::numeric_limits<float>::max()
                 ? fmt::format("is {}, beyond the range of a float; {} is taken", value, bound)
                 : fmt::format("is {} and must {}; {} is taken", value, words_of(range), bound));
    number = bound;
}

}  // namespace petzval::io
