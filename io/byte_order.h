// Values to bytes and back. All our binary files are little endian, and so is every machine we
// build for, so a value's bytes are its memory.
#pragma once

#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace scree {

static_assert(std::endian::native == std::endian::little, "files are written as memory holds them");

template <class Value>
void appendBytes(std::string& bytes, const Value& value)
{
    static_assert(std::is_arithmetic_v<Value>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(Value));
}

/// The value stored at `offset`; the caller knows that it lies inside.
template <class Value>
Value readBytes(std::string_view bytes, std::size_t offset)
{
    static_assert(std::is_arithmetic_v<Value>);
    Value value;
    std::memcpy(&value, bytes.data() + offset, sizeof(Value));
    return value;
}

/// The memory of a contiguous container of numbers (also an Eigen matrix: `data()` and `size()`).
template <class Container>
std::string_view bytesOf(const Container& values)
{
    return {reinterpret_cast<const char*>(values.data()),
            static_cast<std::size_t>(values.size()) * sizeof(*values.data())};
}

}  // namespace scree
