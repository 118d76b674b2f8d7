// SPDX-License-Identifier: Apache-2.0
// A JSON object that may be changed, and its place, which becomes a text only where something is
// said about it: a file may have a million nodes without a fault.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "io/base/json_cursor.h"
#include "io/base/warning_log.h"

namespace petzval::io {

/// Editor of one object. What is not of the type asked for is left alone: the checks refuse it.
class JsonEditor {
  public:
    JsonEditor(nlohmann::json& object, WarningLog& warnings)
        : JsonEditor(object, warnings, nullptr, "", {}) {}

    [[nodiscard]] nlohmann::json& value() const { return *value_; }
    /// The JSON path.
    [[nodiscard]] std::string path() const;
    void warn(std::string_view key, const std::string& message) const;
    void warn(const std::string& message) const;

    /// The value at key; nullptr where there is none.
    [[nodiscard]] nlohmann::json* find(const char* key) const;
    /// The array at key; nullptr where there is none.
    [[nodiscard]] nlohmann::json* array(const char* key) const;
    /// The whole number at key, from 0; nothing where there is none.
    [[nodiscard]] std::optional<uint64_t> integer(const char* key) const;
    /// The object at key.
    [[nodiscard]] std::optional<JsonEditor> find_object(const char* key) const;
    [[nodiscard]] std::optional<JsonEditor> extension(const char* name) const;
    /// Calls visit(editor) for each object in the array at key.
    template <class Visit>
    void each(const char* key, Visit visit) const {
        nlohmann::json* items = array(key);
        for (size_t i = 0; items && i < items->size(); ++i)
            if ((*items)[i].is_object()) visit(JsonEditor((*items)[i], *warnings_, this, key, i));
    }

    /// Takes the value at key away, if there is one, and says why.
    void drop(const char* key, const std::string& message) const;
    /// Takes a value away that is not of the type that is_right(value) wants.
    template <class IsRight>
    void drop_unless(const char* key, IsRight is_right, const std::string& message) const {
        if (const nlohmann::json* at = find(key); at && !is_right(*at)) drop(key, message);
    }
    /// Moves the number at key into the range: in silence where it is off by rounding, else with a
    /// warning.
    void clamp(const char* key, Range) const;
    /// Moves each number of the array at key likewise.
    void clamp_each(const char* key, Range) const;

  private:
    JsonEditor(nlohmann::json& object, WarningLog& warnings, const JsonEditor* up,
               std::string_view key, std::optional<size_t> index)
        : value_(&object), warnings_(&warnings), up_(up), key_(key), index_(index) {}
    void clamp(nlohmann::json& number, const std::string& key, Range) const;

    nlohmann::json* value_;
    WarningLog* warnings_;
    const JsonEditor* up_;  ///< outlives this
    std::string_view key_;
    std::optional<size_t> index_;
    bool is_extension_ = false;
};

}  // namespace petzval::io
