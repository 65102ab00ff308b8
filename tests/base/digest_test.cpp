// Digests: the standard's SHA-256, and lists that cannot be confused.
#include "base/digest.hpp"

#include <gtest/gtest.h>

namespace bedload {
namespace {

TEST(Digest, IsTheStandardsSha256) {
  // FIPS 180-2, appendix B.1 and B.2, and the empty message.
  EXPECT_EQ(Digest().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Digest().add(bytes_of("abc")).hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Digest().add(bytes_of("abcdbcdecdefdefgefghfghighij")).add(bytes_of("hijkijkljklmklmnlmnomnopnopq")).hex(),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Digest, TellsListsOfStringsApart) {
  EXPECT_NE(Digest().add("ab").add("c").hex(), Digest().add("a").add("bc").hex());
  EXPECT_NE(Digest().add("").hex(), Digest().hex());
}

TEST(Digest, TellsNumbersApartToTheLastBit) {
  EXPECT_NE(Digest().add(0.1 + 0.2).hex(), Digest().add(0.3).hex());
  EXPECT_NE(Digest().add(0.0).hex(), Digest().add(-0.0).hex());
}

TEST(Digest, MayBeReadOnTheWay) {
  Digest digest;
  digest.add("a");
  const auto halfway = digest.hex();
  EXPECT_EQ(halfway, digest.hex());
  EXPECT_EQ(digest.add("b").hex(), Digest().add("a").add("b").hex());
}

}   // namespace
}   // namespace bedload
