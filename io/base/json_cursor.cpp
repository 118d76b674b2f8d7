// SPDX-License-Identifier: Apache-2.0
#include "io/base/json_cursor.h"

#include <fmt/format.h>

#include <set>

#include "io/base/error.h"
#include "io/base/json_parse.h"

namespace petzval::io {
namespace {

using nlohmann::json;

/// "must be X, not Y": the one message for a value of the wrong type.
[[noreturn]] void fail_type(const std::string& file, const std::string& place, const char* wanted,
                            const json& value) {
    throw InputError(file, place, "must be {}, but is {}", wanted, printable(value.type_name()));
}

/// A key in a JSON pointer (RFC 6901, section 3).
std::string escaped(std::string_view key) {
    std::string out;
    for (char c : printable(key)) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return out;
}

}  // namespace

JsonCursor::JsonCursor(const json& value, const std::string& file, std::string path)
    : value_(&value), file_(&file), path_(std::move(path)) {
    if (!value.is_object()) fail_type(file, path_, "an object", value);
}

std::string JsonCursor::path_of(std::string_view key) const {
    return path_ + "/" + escaped(key);
}

std::string JsonCursor::element_path(std::string_view key, size_t i) const {
    return fmt::format("{}/{}", path_of(key), i);
}

void JsonCursor::fail(const std::string& message) const {
    throw InputError(*file_, path_, message);
}

void JsonCursor::fail(std::string_view key, const std::string& message) const {
    throw InputError(*file_, path_of(key), message);
}

const json* JsonCursor::find(const char* key) const {
    const auto at = value_->find(key);
    return at == value_->end() ? nullptr : &*at;
}

const json* JsonCursor::find_array(const char* key) const {
    const json* array = find(key);
    if (array && !array->is_array()) fail_type(*file_, path_of(key), "an array", *array);
    return array;
}

void JsonCursor::require(const char* key) const {
    if (!find(key)) fail(fmt::format("has no \"{}\", which it must have", key));
}

JsonCursor JsonCursor::object(const char* key) const {
    require(key);
    return {*find(key), *file_, path_of(key)};
}

std::optional<JsonCursor> JsonCursor::find_object(const char* key) const {
    return find(key) ? std::optional(object(key)) : std::nullopt;
}

std::optional<JsonCursor> JsonCursor::extension(const char* name) const {
    const auto extensions = find_object("extensions");
    return extensions ? extensions->find_object(name) : std::nullopt;
}

std::vector<JsonCursor> JsonCursor::objects(const char* key) const {
    std::vector<JsonCursor> out;
    if (const json* array = find_array(key))
        for (size_t i = 0; i < array->size(); ++i)
            out.emplace_back((*array)[i], *file_, fmt::format("{}/{}/{}", path_, key, i));
    return out;
}

size_t JsonCursor::length(const char* key) const {
    const json* array = find_array(key);
    return array ? array->size() : 0;
}

template <class Place>
uint64_t JsonCursor::as_integer(const json& value, const Place& place) const {
    if (!value.is_number()) fail_type(*file_, place(), "a whole number", value);
    const double number = value.get<double>();
    if (!value.is_number_integer() || number < 0 || number > 0x1p53)
        throw InputError(*file_, place(), "must be a whole number from 0 to 2^53, but is {}",
                         number);
    return value.get<uint64_t>();
}

uint64_t JsonCursor::integer(const char* key) const {
    require(key);
    return as_integer(*find(key), [&] { return path_of(key); });
}

uint64_t JsonCursor::integer_or(const char* key, uint64_t otherwise) const {
    return find(key) ? integer(key) : otherwise;
}

template <class Place>
double JsonCursor::as_number(const json& value, const Place& place, Range range) const {
    if (!value.is_number()) fail_type(*file_, place(), "a number", value);
    const double number = value.get<double>();
    if (!(number >= range.low && number <= range.high))
        throw InputError(*file_, place(), "must be from {} to {}, but is {}", range.low, range.high,
                         number);
    return number;
}

double JsonCursor::number(const char* key, Range range) const {
    require(key);
    return as_number(
        *find(key), [&] { return path_of(key); }, range);
}

double JsonCursor::number_or(const char* key, double otherwise, Range range) const {
    return find(key) ? number(key, range) : otherwise;
}

std::vector<double> JsonCursor::numbers(const char* key, size_t count, Range range) const {
    const json* array = find_array(key);
    if (!array) return {};
    if (array->size() != count)
        fail(key, fmt::format("must hold {} numbers, but holds {}", count, array->size()));
    std::vector<double> out;
    out.reserve(count);
    for (size_t i = 0; i < count; ++i)
        out.push_back(as_number((*array)[i], [&] { return element_path(key, i); }, range));
    return out;
}

std::string JsonCursor::text(const char* key) const {
    require(key);
    const json& value = *find(key);
    if (!value.is_string()) fail_type(*file_, path_of(key), "a string", value);
    return value.get<std::string>();
}

std::string JsonCursor::text_or(const char* key, const char* otherwise) const {
    return find(key) ? text(key) : otherwise;
}

void JsonCursor::check_bool(const char* key) const {
    const json* value = find(key);
    if (value && !value->is_boolean()) fail_type(*file_, path_of(key), "true or false", *value);
}

template <class Place>
size_t JsonCursor::as_index(const json& value, const Place& place, size_t count,
                            const char* what) const {
    const uint64_t index = as_integer(value, place);
    if (index >= count)
        throw InputError(*file_, place(), "there is no {} {}; the file has {}", what, index, count);
    return index;
}

std::optional<size_t> JsonCursor::index(const char* key, size_t count, const char* what) const {
    return find(key) ? std::optional(required_index(key, count, what)) : std::nullopt;
}

size_t JsonCursor::required_index(const char* key, size_t count, const char* what) const {
    require(key);
    return as_index(
        *find(key), [&] { return path_of(key); }, count, what);
}

std::vector<size_t> JsonCursor::indices(const char* key, size_t count, const char* what) const {
    const json* array = find_array(key);
    if (!array) return {};
    std::vector<size_t> out;
    std::set<size_t> seen;
    for (size_t i = 0; i < array->size(); ++i) {
        const auto place = [&] { return element_path(key, i); };
        out.push_back(as_index((*array)[i], place, count, what));
        if (!seen.insert(out.back()).second)
            throw InputError(*file_, place(), "names {} {} again", what, out.back());
    }
    return out;
}

}  // namespace petzval::io
