// Bytes that nobody vouches for, read from front to back.
#pragma once

#include <cstring>
#include <functional>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "io/byte_order.h"

namespace scree {

/// The one place that compares what a file asks for with what is left of it, before memory is taken
/// for it. What a cut file means differs from reader to reader: each brings a `refuse`, which must
/// throw.
class ByteCursor {
public:
    ByteCursor(std::string_view bytes, std::function<void()> refuse)
        : bytes_(bytes), refuse_(std::move(refuse))
    {
    }

    bool isAtEnd() const { return bytes_.empty(); }

    /// Refuses when there are not `count` elements of that size left.
    void require(std::size_t count, std::size_t elementBytes) const
    {
        if (count > bytes_.size() / elementBytes) refuse_();
    }

    std::string_view takeText(std::size_t length)
    {
        require(length, 1);
        const std::string_view text = bytes_.substr(0, length);
        bytes_.remove_prefix(length);
        return text;
    }

    template <class Value>
    Value take()
    {
        return readBytes<Value>(takeText(sizeof(Value)), 0);
    }

    /// Fills what has been made for them; after require().
    template <class Element>
    void takeInto(std::span<Element> elements)
    {
        static_assert(std::is_trivially_copyable_v<Element>);
        require(elements.size(), sizeof(Element));
        const std::string_view text = takeText(elements.size_bytes());
        // Neither side need have an address where there is nothing.
        if (!text.empty()) std::memcpy(elements.data(), text.data(), text.size());
    }

private:
    std::string_view bytes_;
    std::function<void()> refuse_;
};

}  // namespace scree
