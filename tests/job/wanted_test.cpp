#include "job/wanted.h"

#include <gtest/gtest.h>

#include "contains.h"

namespace hydrodip {
namespace {

// From where film surely holds to where none does; what is torn is lost, not doubtful.
TEST(Doubt, IsWhereFilmMayHoldOrLieElsewhere) {
  const DoubtfulStretch doubtful{1.2, 1.5};
  const auto in_doubt = [&](double stretch, double moved_mm, bool let_go) {
    return is_in_doubt(FilmMap::Hold{stretch, moved_mm, true, let_go}, doubtful);
  };
  EXPECT_FALSE(in_doubt(1.1, 0, false));
  EXPECT_TRUE(in_doubt(1.3, 0, false));
  EXPECT_FALSE(in_doubt(1.6, 0, false));
  EXPECT_FALSE(in_doubt(1.6, 2, false));
  EXPECT_TRUE(in_doubt(1.1, 0.4, false));
  EXPECT_FALSE(in_doubt(1.3, 0.4, true));
  EXPECT_FALSE(is_in_doubt(std::nullopt, doubtful));
}

// The first half of the places shows the picture.
TEST(DryLayers, AreThoseThatGetNoFilmOrHardlyAny) {
  Targets targets;
  for (int i = 0; i < 100; ++i) {
    Target target;
    target.point.triangle = i;
    target.area = 1;
    targets.list.push_back(target);
  }
  LaidLayer layer;
  layer.name = "logo.png";
  layer.shows = [](const SurfacePoint& point) { return point.triangle < 50; };
  const auto dry_where_film_begins_at = [&](int first) {
    return dry_layers({layer}, targets,
                      [&](const Target& at) { return at.point.triangle >= first; });
  };
  EXPECT_TRUE(dry_where_film_begins_at(0).empty());
  EXPECT_TRUE(dry_where_film_begins_at(40).empty());
  ASSERT_EQ(dry_where_film_begins_at(49).size(), 1U);
  EXPECT_TRUE(contains(dry_where_film_begins_at(49)[0].told, "logo.png: this artwork gets hardly"));
  ASSERT_EQ(dry_where_film_begins_at(50).size(), 1U);
  EXPECT_TRUE(contains(dry_where_film_begins_at(50)[0].told, "gets no film"));
}

}  // namespace
}  // namespace hydrodip
