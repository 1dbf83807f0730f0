#include "self_awareness/ros/encoding.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "../problem.h"
#include "../times.h"
#include "self_awareness/core/stream/mode.h"
#include "self_awareness/ros/stable_name.h"
#include "serialized.h"

namespace self_awareness::ros1 {
namespace {

/// Why rules are refused; empty: they are not.
std::string problemIn(const EncodingRules& rules) {
  return problemOf([&] { rules.validate(); });
}

class EncoderTest : public testing::Test {
 protected:
  Encoder makeEncoder(const EncodingRules& rules) {
    return Encoder(rules,
                   [this](const core::EventType& type) { return vocabulary_.intern(type); });
  }
  static Connection scan() { return {"/player", "/scan", "sensor_msgs/LaserScan", "", false, ""}; }
  /// Of a node that sends such messages.
  template <typename Message>
  static Connection connectionOf(const std::string& callerid, const std::string& topic) {
    return connectionFrom(*headerOf<Message>(callerid), topic);
  }

  core::Vocabulary vocabulary_;
};

TEST(ResolvedName, IsTheWholeOneAndStaysSo) {
  EXPECT_EQ(resolvedName("camera/depth//image/"), "/camera/depth/image");
  EXPECT_EQ(resolvedName("///ns///topic"), "/ns/topic");
  EXPECT_EQ(resolvedName("_x"), "/_x");
  EXPECT_EQ(resolvedName("//"), "/");
  for (const char* name : {"", "/", "/scan", "~scan", "(further topics)", "*"}) {
    EXPECT_EQ(resolvedName(name), name);
  }
}

TEST(StableName, DropsTheNumbersOfAnonymousNodesAndNoOthers) {
  EXPECT_EQ(stableName("rostopic_10263_1795206536731"), "/rostopic") << "and the name is whole";
  EXPECT_EQ(stableName("/record_1795206538727453261"), "/record");
  EXPECT_EQ(stableName("//ns/talker_4242_1430709709567"), "/ns/talker");
  EXPECT_EQ(stableName("/viewer_host_314_5876409862321874321"), "/viewer_host");
  for (const char* name : {"/camera_752112070204", "/laser_2", "/wheel_1_2", "/robot_20211104"}) {
    EXPECT_EQ(stableName(name), name);
  }
}

TEST_F(EncoderTest, AnEventIsSourceScopeAndType) {
  Connection connection = scan();
  connection.callerid = "/player_4242_1430709709567";
  auto encoder = makeEncoder(EncodingRules()).connect(connection);
  ASSERT_TRUE(encoder);
  EXPECT_EQ(vocabulary_.size(), 0U);  // a connection alone is no event
  EXPECT_FALSE(encoder->needsContent());
  const core::EventType expected{"/player", "/scan", "sensor_msgs/LaserScan"};
  EXPECT_EQ(vocabulary_.at(encoder->id()), expected);
}

Connection loads() {
  return {"/arm", "/load", "a/Load", "uint8 number\nfloat32 force\nint16 level\nstring text",
          false,  ""};
}

std::vector<std::uint8_t> loadOf(float force, std::int16_t level) {
  std::vector<std::uint8_t> bytes(1 + sizeof force + sizeof level + 4, 0);
  std::memcpy(bytes.data() + 1, &force, sizeof force);
  std::memcpy(bytes.data() + 1 + sizeof force, &level, sizeof level);
  return bytes;
}

EncodingRules rulesOfClasses(const std::string& field, std::vector<double> bounds) {
  EncodingRules rules;
  rules.type_fields = {{"a/Load", field}};
  rules.classes = {{"a/Load", {4, std::move(bounds)}}};
  return rules;
}

TEST_F(EncoderTest, ValuesArePutIntoClasses) {
  const auto typeOf = [&](const EncodingRules& rules, float force, std::int16_t level) {
    auto encoder = makeEncoder(rules).connect(loads());
    const std::vector<std::uint8_t> bytes = loadOf(force, level);
    return vocabulary_.at(encoder->id(bytes.data(), bytes.size())).type;
  };
  const EncodingRules force = rulesOfClasses("force", {-0.5, 0.25, 1e6});
  EXPECT_EQ(typeOf(force, -3, 0), "a/Load[force=below -0.5]");
  EXPECT_EQ(typeOf(force, -0.5F, 0), "a/Load[force=-0.5 to 0.25]");
  EXPECT_EQ(typeOf(force, 0.25F, 0), "a/Load[force=0.25 to 1e+06]");
  EXPECT_EQ(typeOf(force, INFINITY, 0), "a/Load[force=1e+06 or more]");
  EXPECT_EQ(typeOf(force, -INFINITY, 0), "a/Load[force=below -0.5]");
  EXPECT_EQ(typeOf(force, NAN, 0), "a/Load[force=NaN]");
  const EncodingRules level = rulesOfClasses("level", {7});
  EXPECT_EQ(typeOf(level, 0, 6), "a/Load[level=below 7]");
  EXPECT_EQ(typeOf(level, 0, 7), "a/Load[level=7 or more]");
}

TEST_F(EncoderTest, ClassesThatCannotBeAreNamed) {
  const auto why = [&](const EncodingRules& rules) {
    return problemOf([&] {
      rules.validate();
      makeEncoder(rules).connect(loads());
    });
  };
  EXPECT_EQ(why(rulesOfClasses("force", {1, 2, 3})), "");
  EXPECT_TRUE(has(why(rulesOfClasses("force", {})), "a/Load: force are not learned yet"));
  EXPECT_TRUE(has(why(rulesOfClasses("text", {1})), "only numbers have classes"));
  for (const std::vector<double>& bounds :
       {std::vector<double>{1, 2, 3, 4}, {2, 1}, {1, 1}, {NAN}, {INFINITY}}) {
    EXPECT_TRUE(has(why(rulesOfClasses("force", bounds)), "ascending bounds"));
  }
  EncodingRules rules = rulesOfClasses("force", {1});
  rules.classes["a/Load"].number = 17;
  EXPECT_TRUE(has(why(rules), "2 to 16, not 17"));
  rules.type_fields.clear();
  EXPECT_TRUE(has(why(rules), "a/Load"));
}

EncodingRules rulesOfMode(const std::string& topic, const std::string& field) {
  EncodingRules rules = EncodingRules::defaults();
  rules.mode = ModeField{topic, field};
  return rules;
}

TEST_F(EncoderTest, AMessageOfTheModeIsAnEventAndTellsTheMode) {
  std_msgs::String message;
  Connection connection = connectionOf<std_msgs::String>("/logic", "/r7/state");
  connection.latching = true;
  EncodingRules rules = rulesOfMode("/state", "data");
  rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
  auto encoder = makeEncoder(rules).connect(connection);
  ASSERT_TRUE(encoder);
  EXPECT_TRUE(encoder->tellsMode());
  EXPECT_TRUE(encoder->needsContent());
  EXPECT_FALSE(encoder->accept()) << "what was latched is still no event but of the mode";
  message.data = "DRIVING";
  const std::vector<std::uint8_t> driving = serialized(message);
  message.data = "DOCKED";
  const std::vector<std::uint8_t> docked = serialized(message);
  const core::EventId drives = encoder->mode(driving.data(), driving.size());
  EXPECT_EQ(core::toString(vocabulary_.at(drives)),
            "/logic /state std_msgs/String[mode: DRIVING]");
  EXPECT_TRUE(vocabulary_.tellsMode(drives));
  EXPECT_NE(encoder->mode(docked.data(), docked.size()), drives);
  EXPECT_EQ(encoder->mode(driving.data(), driving.size()), drives);
  const core::EventId plain = encoder->id(driving.data(), driving.size());
  EXPECT_EQ(vocabulary_.at(plain).type, "std_msgs/String");
  EXPECT_EQ(encoder->id(docked.data(), docked.size()), plain);
  connection.topic = "/other";
  EXPECT_FALSE(makeEncoder(rules).connect(connection)->tellsMode());
}

TEST_F(EncoderTest, AFieldOfTheModeThatIsNotThereIsNamed) {
  Connection connection = scan();
  connection.definition = "string data";
  connection.datatype = "std_msgs/String";
  const std::string problem =
      problemOf([&] { makeEncoder(rulesOfMode("/scan", "state")).connect(connection); });
  EXPECT_TRUE(has(problem, "the mode on /scan: "));
  EXPECT_TRUE(has(problem, "std_msgs/String: state"));
}

TEST(EncodingRules, AModeThatCannotBeToldIsNamed) {
  EXPECT_EQ(problemIn(rulesOfMode("/state", "data")), "");
  for (const char* topic : {"state", "", "/a b", "~state"}) {
    EXPECT_TRUE(has(problemIn(rulesOfMode(topic, "data")), "not the name of a topic"));
  }
  EXPECT_TRUE(has(problemIn(rulesOfMode("/state", "")), "no field"));
  EXPECT_TRUE(has(problemIn(rulesOfMode("/clock", "clock")), "exclude_topics"));
  EncodingRules rules = rulesOfMode("/state", "data");
  rules.include_topics = {"/scan"};
  EXPECT_TRUE(has(problemIn(rules), "include_topics"));
  rules.include_topics.emplace_back("/sta.*");
  EXPECT_EQ(problemIn(rules), "");
}

TEST(EventTypes, TooManyModesAreNamed) {
  core::Vocabulary vocabulary;
  for (std::size_t k = 0; k <= kMostTypesOfField; ++k) {
    vocabulary.intern({"/logic", "/state", core::typeOfMode("a/B", std::to_string(k))});
  }
  EXPECT_TRUE(has(problemOf([&] { checkEventTypes(rulesOfMode("/state", "id"), vocabulary); }),
                  "/state: id"));
}

TEST_F(EncoderTest, SourcesMayBeLeftOut) {
  EncodingRules rules = EncodingRules::defaults();
  rules.source = EncodingRules::Source::kNone;
  Connection connection = scan();
  connection.callerid = "/play_1795206538727453261";  // it would be excluded
  auto encoder = makeEncoder(rules).connect(connection);
  ASSERT_TRUE(encoder);
  EXPECT_EQ(vocabulary_.at(encoder->id()).source, "");
  EXPECT_EQ(core::toString(vocabulary_.at(encoder->id())), "- /scan sensor_msgs/LaserScan");
  EXPECT_TRUE(makeEncoder(rules).includesSource("/play"));
  EXPECT_FALSE(makeEncoder(EncodingRules::defaults()).includesSource("/play"));
}

TEST_F(EncoderTest, NamesMayBeReplacedAndAllRulesSeeTheNewOnes) {
  EncodingRules rules;
  rules.renames = {{"/r[0-9]+/lidar", "/scan"}, {"/r[0-9]+/(.*)", "/\\1"}, {"/scan", "/never"}};
  rules.exclude_topics = {"/debug"};
  rules.exclude_sources = {"/tool"};
  const Encoder encoder = makeEncoder(rules);
  EXPECT_EQ(encoder.scopeOf("/r12/pose"), "/pose");
  EXPECT_EQ(encoder.scopeOf("/r12/lidar"), "/scan") << "by the first rule, and by no further one";
  EXPECT_EQ(encoder.scopeOf("/map/r12/pose"), "/map/r12/pose") << "must match the whole name";
  EXPECT_EQ(encoder.sourceOf("/r12/slam_4242_1600000000000"), "/slam");
  EXPECT_FALSE(encoder.includesTopic("/r3/debug"));
  EXPECT_FALSE(encoder.includesSource("/r3/tool"));
  EXPECT_FALSE(encoder.listens("/r3/tool"));
  for (const char* robot : {"/r1", "/r2"}) {
    Connection connection = scan();
    connection.callerid = robot + connection.callerid;
    connection.topic = robot + connection.topic;
    auto connected = encoder.connect(connection);
    ASSERT_TRUE(connected);
    EXPECT_EQ(core::toString(vocabulary_.at(connected->id())),
              "/player /scan sensor_msgs/LaserScan");
  }
  EXPECT_EQ(vocabulary_.size(), 1U);
}

TEST(Rename, WholeNamesAreReplacedTypedWithOrWithoutTheFirstSlash) {
  const auto encoderBy = [](const std::vector<Rename>& renames) {
    EncodingRules rules;
    rules.renames = renames;
    return Encoder(rules, nullptr);
  };
  const Encoder shortest = encoderBy({{"/(r|r1)/scan|/r", "/\\1x"}});
  EXPECT_EQ(shortest.scopeOf("/r1/scan"), "/r1x") << "whatever the shortest match";
  EXPECT_EQ(shortest.scopeOf("/r"), "/x") << "a group that matches nothing is empty";
  const Encoder typed =
      encoderBy({{"r[0-9]+/(.*)", "/\\1"}, {"(scan|odom)", "/all//\\1"}, {"(.*)", "/x/\\1"}});
  EXPECT_EQ(typed.scopeOf("/r7/cloud"), "/cloud");
  EXPECT_EQ(typed.scopeOf("r7/cloud"), "/cloud");
  EXPECT_EQ(typed.scopeOf("//odom"), "/all/odom");
  EXPECT_EQ(typed.sourceOf("lidar"), "/x/lidar") << "the whole name is matched first";
}

TEST(Rename, WhatCannotBeDoneIsNamed) {
  const auto problem = [](const std::string& pattern, const std::string& name) {
    EncodingRules rules;
    rules.renames = {{pattern, name}};
    return problemIn(rules);
  };
  EXPECT_EQ(problem("/r[0-9]+/(.*)", "/\\1"), "");
  EXPECT_TRUE(has(problem("/r(", "/x"), "'/r(' is not a regular expression"));
  EXPECT_TRUE(has(problem("/r", "/\\1"), "'/\\1' that takes the place of '/r' does not fit"));
  EXPECT_TRUE(has(problem("/r/(.*)", "\\1"), "must begin with a slash"));
  EXPECT_TRUE(has(problem("/r", "/" + std::string(kLongestName, 'x')), "too long"));
}

TEST_F(EncoderTest, WhatIsLatchedOnlySaysThatItIsThere) {
  Connection connection = scan();
  connection.latching = true;
  auto encoder = makeEncoder(EncodingRules::defaults()).connect(connection);
  EXPECT_FALSE(encoder->accept());
  const core::EventId latched = encoder->latched().value();
  EXPECT_TRUE(vocabulary_.isLatched(latched));
  EXPECT_EQ(core::toString(vocabulary_.at(latched)),
            "/player /scan sensor_msgs/LaserScan[latched]");
  EXPECT_TRUE(encoder->accept()) << "the second one was published now";
  EXPECT_FALSE(vocabulary_.isLatched(encoder->id()));
  connection.datatype = "rosgraph_msgs/Log";
  EXPECT_FALSE(makeEncoder(EncodingRules()).connect(connection)->latched());
}

TEST_F(EncoderTest, NobodyMakesUpAModeOrWhatIsLatched) {
  Connection connection = scan();
  for (const std::string& type :
       {core::typeOfMode("a/B", "DRIVING"), std::string("a/B[latched]")}) {
    connection.datatype = type;
    EXPECT_FALSE(makeEncoder(EncodingRules()).connect(connection));
    EXPECT_TRUE(has(whyLeftOut(connection), "is no name of a type"));
  }
}

TEST_F(EncoderTest, AFieldOfATypeInMessagesIsTheirs) {
  Connection connection{"/arm", "/move/result", "arm/MoveActionResult", "", false, ""};
  connection.definition =
      "a/Goal[] others\na/Goal status\n====\nMSG: a/Goal\nuint8 ACTIVE=1\nuint8 status\n";
  EncodingRules rules;
  rules.type_fields = {{"a/Goal", "status"}};
  auto encoder = makeEncoder(rules).connect(connection);
  const std::vector<std::uint8_t> message{0, 0, 0, 0, 4};
  ASSERT_TRUE(encoder->needsContent());
  EXPECT_EQ(vocabulary_.at(encoder->id(message.data(), message.size())).type,
            "arm/MoveActionResult[status.status=4]");
  connection.definition = "a/Goal[] status\n====\nMSG: a/Goal\nuint8 status\n";
  EXPECT_FALSE(makeEncoder(rules).connect(connection)->needsContent()) << "one of many says less";
  connection.definition = "a/Goal status\n";
  EXPECT_FALSE(makeEncoder(rules).connect(connection)->needsContent()) << "it cannot be read";
}

/// Says what messages of /gps list, as they come by DiagnosticArray and by names.
class ListTest : public EncoderTest {
 protected:
  void connect(const std::string& path, bool latching = false,
               const std::string& sender = "/r1/gps") {
    Connection connection = connectionOf<diagnostic_msgs::DiagnosticArray>(sender, "/r1/d");
    connection.latching = latching;
    EncodingRules rules;
    rules.type_fields = {{"diagnostic_msgs/DiagnosticArray", path}};
    rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
    encoder_ = makeEncoder(rules).connect(connection);
  }
  /// What a message with these names and levels tells, besides that it came; empty: nothing.
  std::string told(std::int64_t stamp, const std::vector<std::pair<std::string, int>>& all) {
    diagnostic_msgs::DiagnosticArray message;
    for (const auto& [name, level] : all) {
      message.status.emplace_back();
      message.status.back().name = name;
      message.status.back().level = static_cast<signed char>(level);
    }
    const std::vector<std::uint8_t> bytes = serialized(message);
    const auto id = encoder_->list(bytes.data(), bytes.size(), stamp);
    EXPECT_EQ(vocabulary_.at(encoder_->id(bytes.data(), bytes.size())).type,
              "diagnostic_msgs/DiagnosticArray");
    EXPECT_TRUE(!id || (vocabulary_.tellsList(*id) && !vocabulary_.isMessage(*id)));
    return id ? vocabulary_.at(*id).type.substr(31) : "";
  }

  std::optional<ConnectionEncoder> encoder_;
};

TEST_F(ListTest, WhatMessagesListIsToldWhenItChangesAndOnceASecond) {
  connect("status.name");
  ASSERT_TRUE(encoder_->needsContent());
  const std::string both = "[lists status.name: b, r1x]";
  EXPECT_EQ(told(0, {{"r1/b", 0}, {"r1x", 0}}), both) << "renamed as topics are";
  EXPECT_EQ(told(1, {{"r1x", 0}, {"r1/b", 0}}), "") << "the same, in another order";
  EXPECT_EQ(told(2, {{"r1x", 0}}), "[lists status.name: r1x]");
  EXPECT_EQ(told(3, {}), "") << "an empty one says nothing";
  EXPECT_EQ(told(4, {{"r1/b", 0}, {"r1x", 0}}), both);
  EXPECT_EQ(told(kSecond, {{"r1/b", 0}, {"r1x", 0}}), "");
  EXPECT_EQ(told(kSecond + 4, {{"r1/b", 0}, {"r1x", 0}}), both) << "it lasts";
  EXPECT_EQ(told(5, {{"r1/b", 0}, {"r1x", 0}}), both) << "the clock was set";
}

TEST_F(ListTest, OfNumbersTheLargestOneIsToldAndNothingOfWhatIsLatchedOrOfNobody) {
  connect("status.level");
  EXPECT_EQ(told(0, {{"a", 0}, {"b", 2}, {"c", 1}}), "[lists status.level: 2]");
  connect("status.name", true);
  EXPECT_FALSE(encoder_->needsContent());
  connect("status.name", false, "");
  EXPECT_FALSE(encoder_->needsContent());
}

TEST_F(ListTest, WhoInventsListsIsNotFollowed) {
  connect("status.name");
  for (int k = 0; k < 16; ++k) {
    EXPECT_EQ(told(k, {{std::to_string(k), 0}}), "[lists status.name: " + std::to_string(k) + "]");
  }
  EXPECT_EQ(told(16, {{"more", 0}}), "[lists status.name: ]");
  EXPECT_EQ(told(17, {{"0", 0}}), "[lists status.name: ]");
}

TEST_F(ListTest, AFieldThatCannotBeListedIsNamed) {
  EXPECT_EQ(problemOf([&] { connect("status.values.key"); }),
            "type field diagnostic_msgs/DiagnosticArray: status.values.key: 'values' is an array "
            "in an array; name a field of one array");
  EXPECT_EQ(problemOf([&] { connect("status.gone"); }),
            "type field diagnostic_msgs/DiagnosticArray: status.gone: has no field 'gone' in its "
            "diagnostic_msgs/DiagnosticStatus");
  EXPECT_EQ(problemOf([&] { connect("status"); }),
            "type field diagnostic_msgs/DiagnosticArray: status: is a message itself; name one of "
            "its fields");
}

TEST_F(EncoderTest, TheOnlyMessageOfRostopicIsAnEvent) {
  Connection connection = scan();
  connection.latching = true;
  connection.callerid = "/ns/rostopic_10263_1795206536731";
  auto encoder = makeEncoder(EncodingRules::defaults()).connect(connection);
  ASSERT_TRUE(encoder);
  EXPECT_TRUE(encoder->accept());
  EXPECT_EQ(vocabulary_.at(encoder->id()).source, "/ns/rostopic");
  connection.callerid = "/not_rostopic";
  EXPECT_FALSE(makeEncoder(EncodingRules::defaults()).connect(connection)->accept());
}

TEST_F(EncoderTest, DefaultsLeaveOutOnlookersAndKeepTheRobot) {
  const Encoder encoder = makeEncoder(EncodingRules::defaults());
  Connection connection = scan();
  for (const char* node : {"/player", "/recorder_arm", "/replay_guard", "/base", "/ns/player",
                           "/rostopic_10263_1795206536731"}) {
    connection.callerid = node;
    EXPECT_TRUE(encoder.connect(connection)) << node;
  }
  for (const char* node : {"/play_1795206538727453261", "/record_1795206538727453261",
                           "/rqt_gui_py_node_17", "/rviz_1430709709567731649", "/self_awareness",
                           "/robot1/self_awareness_manager", "/ns/rviz"}) {
    connection.callerid = node;
    EXPECT_FALSE(encoder.connect(connection)) << node;
  }
  // Nor do tools of people who watch use a topic.
  EXPECT_TRUE(encoder.listens("/slam"));
  EXPECT_TRUE(encoder.listens("/player")) << "is not /play";
  for (const char* tool : {"/record", "/recorder", "/rqt_graph", "/robot/rviz", "/rostopic"}) {
    EXPECT_FALSE(encoder.listens(tool)) << tool;
  }
  for (const char* topic : {"/clock", "/rosout_agg", "/statistics", "/self_awareness/status",
                            "/bond", "/robot_manager/bond"}) {
    EXPECT_FALSE(encoder.includesTopic(topic)) << topic;
  }
  for (const char* topic : {"/scan", "/rosout", "/diagnostics", "/alarm_clock", "/vagabond"}) {
    EXPECT_TRUE(encoder.includesTopic(topic)) << topic;
  }
}

TEST_F(EncoderTest, PatternsMatchWholeNamesTypedWithOrWithoutTheFirstSlash) {
  EncodingRules rules;
  rules.include_topics = {"scan|odom"};
  rules.exclude_sources = {"play"};
  const Encoder encoder = makeEncoder(rules);
  for (const char* topic : {"/scan", "scan", "//odom"}) {
    EXPECT_TRUE(encoder.includesTopic(topic)) << topic;
  }
  EXPECT_FALSE(encoder.includesTopic("/laser/scan"));
  EXPECT_FALSE(encoder.includesSource("/play"));
  EXPECT_TRUE(encoder.includesSource("/player"));
  EXPECT_FALSE(makeEncoder(EncodingRules::defaults()).includesTopic("clock"));
  for (const bool heard : {true, false}) {
    rules = {};
    rules.include_sources = {heard ? "/pl.*" : "/slam"};
    EXPECT_EQ(makeEncoder(rules).connect(scan()).has_value(), heard);
  }
}

TEST_F(EncoderTest, NoPatternAndNoNameTakesForever) {
  EncodingRules rules;
  rules.exclude_topics = {"(([a-z/_])*)*#", "(a*)*(a*)*(a*)*b", ".*.*.*.*.*.*x"};
  rules.exclude_sources = rules.exclude_topics;
  const Encoder encoder = makeEncoder(rules);
  Connection connection = scan();
  connection.topic = "/" + std::string(999, 'a');
  connection.callerid = connection.topic;
  EXPECT_TRUE(encoder.connect(connection));
  connection.callerid = "/" + std::string(30000, 'a');
  EXPECT_FALSE(encoder.connect(connection));
  stableName(connection.callerid + "_1");
}

TEST_F(EncoderTest, PatternsThatGrowAreRefused) {
  EncodingRules rules;
  std::string nested = "a";
  for (int level = 0; level < 20000; ++level) {
    nested = "(" + nested + ")";
  }
  for (const std::string& pattern : {std::string("(((a{1,100}){1,100}){1,100}){1,100}"), nested,
                                     std::string("\xFF\xFE["), std::string("(a)\\1")}) {
    rules.include_topics = {pattern};
    EXPECT_NE(problemIn(rules), "") << pattern.substr(0, 50);
    EXPECT_LT(problemIn(rules).size(), 500U);
  }
  rules.include_topics.assign(100000, "/a[0-9]{5}");
  EXPECT_THROW(rules.validate(), std::invalid_argument);
}

TEST_F(EncoderTest, NewValuesWithoutEndTakeNoMemory) {
  EncodingRules rules;
  rules.type_fields = {{"test/Value", "value"}};
  const Encoder encoder(rules, [this](const core::EventType& type) {
    return internUpTo(kMostEventTypes, type, vocabulary_);
  });
  Connection connection = scan();
  connection.datatype = "test/Value";
  connection.definition = "uint32 value\n";
  auto encoded = encoder.connect(connection);
  ASSERT_TRUE(encoded);
  std::vector<std::uint8_t> message(4);
  for (std::uint32_t value = 0; value < 3 * kMostEventTypes; ++value) {
    std::memcpy(message.data(), &value, sizeof value);
    const core::EventId id = encoded->id(message.data(), message.size());
    EXPECT_EQ(id, std::min<std::size_t>(value, kMostEventTypes));
  }
  EXPECT_EQ(vocabulary_.size(), kMostEventTypes + 1);
  const std::uint32_t known = 3;
  std::memcpy(message.data(), &known, sizeof known);
  EXPECT_EQ(encoded->id(message.data(), message.size()), known) << "what was known stays";
  EXPECT_THROW(checkEventTypes({}, vocabulary_), std::invalid_argument);
}

}  // namespace
}  // namespace self_awareness::ros1
