// SPDX-License-Identifier: Apache-2.0
// Volumes that a point lies in: glass in glass, by priority.
#pragma once

#include <array>

#include "core/scene/material.h"

namespace petzval {

/// Nested dielectrics: the volumes that a point of a path is in. Of closed ones, the one of the
/// highest priority fills space (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray Traced
/// Images"). Of volumes whose surface is not closed only the last one is remembered, and closed
/// ones come before it.
class Volumes {
  public:
    /// Volume that fills space, or null for air.
    [[nodiscard]] const Material* filling() const {
        return size_ > 0 ? closed_[0].material : open_;
    }
    /// Closed volume that fills space, or null.
    [[nodiscard]] const Material* closed_filling() const {
        return size_ > 0 ? closed_[0].material : nullptr;
    }

    /// Makes true what the side of a face says on which the path arrives. It may have begun inside,
    /// as the camera's does, or slipped through a seam.
    void correct(const Material& m, bool front) {
        if (m.priority == 0) {
            if (!front) open_ = &m;
            return;
        }
        const int at = find(m);
        if (!front && at < 0) add(m, 1);
        if (front && at >= 0 && !m.overlaps_itself) remove(at);
    }
    /// Crosses a face; enters: from its front to its back.
    void cross(const Material& m, bool enters) {
        if (m.priority == 0) {
            open_ = enters ? &m : nullptr;
            return;
        }
        add(m, enters ? 1 : -1);
    }
    /// Enters a closed volume `count` times, or leaves it so often where that is negative. Never
    /// below 0. Where eight are full, the one of the lowest priority is forgotten.
    void add(const Material& m, int count) {
        const int at = find(m);
        if (at >= 0) {
            auto& entry = closed_[static_cast<size_t>(at)];
            entry.count += count;
            if (entry.count <= 0) remove(at);
        } else if (count > 0) {
            insert(m, count);
        }
    }

    friend bool operator==(const Volumes& a, const Volumes& b) {
        if (a.size_ != b.size_ || a.open_ != b.open_) return false;
        for (size_t i = 0; i < static_cast<size_t>(a.size_); ++i)
            if (a.closed_[i].material != b.closed_[i].material ||
                a.closed_[i].count != b.closed_[i].count)
                return false;
        return true;
    }

  private:
    static constexpr int kMost = 8;
    struct Entry {
        const Material* material;
        int count;
    };

    [[nodiscard]] int find(const Material& m) const {
        for (int i = 0; i < size_; ++i)
            if (closed_[static_cast<size_t>(i)].material == &m) return i;
        return -1;
    }
    void remove(int at) {
        --size_;
        for (auto i = static_cast<size_t>(at); i < static_cast<size_t>(size_); ++i)
            closed_[i] = closed_[i + 1];
    }
    void insert(const Material& m, int count) {
        int at = size_;
        while (at > 0 && closed_[static_cast<size_t>(at - 1)].material->priority < m.priority) --at;
        if (at == kMost) return;
        if (size_ < kMost) ++size_;
        for (int i = size_ - 1; i > at; --i)
            closed_[static_cast<size_t>(i)] = closed_[static_cast<size_t>(i - 1)];
        closed_[static_cast<size_t>(at)] = {&m, count};
    }

    std::array<Entry, kMost> closed_;  ///< by falling priority
    int size_ = 0;
    const Material* open_ = nullptr;
};

}  // namespace petzval
