/// Some of the values of an enumeration.
#pragma once

namespace alcove {

/// Of an enumeration with at most 32 values, counted from 0.
template <class E>
class EnumSet {
  public:
    constexpr EnumSet() = default;
    constexpr EnumSet(E value) : bits_(1u << static_cast<unsigned>(value)) {}

    constexpr bool has(E value) const { return (bits_ & EnumSet(value).bits_) != 0; }
    constexpr bool empty() const { return bits_ == 0; }
    constexpr EnumSet operator|(EnumSet other) const { return EnumSet(bits_ | other.bits_); }
    constexpr EnumSet operator&(EnumSet other) const { return EnumSet(bits_ & other.bits_); }
    constexpr EnumSet without(EnumSet other) const { return EnumSet(bits_ & ~other.bits_); }
    constexpr bool operator==(const EnumSet&) const = default;

  private:
    constexpr explicit EnumSet(unsigned bits) : bits_(bits) {}
    unsigned bits_ = 0;
};

}
