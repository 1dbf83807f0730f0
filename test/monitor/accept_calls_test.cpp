#include "monitor/accept_calls.h"

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../await.h"
#include "ros/verdict/accepted_file.h"

namespace self_awareness {
namespace {

namespace fs = boost::filesystem;

core::Suspect suspect(core::EventId id, const std::string& component, core::Kind kind,
                      bool abnormal = true) {
  core::Suspect suspect;
  suspect.id = id;
  suspect.component = component;
  suspect.abnormal = abnormal;
  suspect.reason.kind = kind;
  return suspect;
}

self_awareness::Acceptance named(const std::string& component, const std::string& topic,
                                 const std::string& kind = "") {
  self_awareness::Acceptance one;
  one.component = component;
  one.topic = topic;
  one.kind = kind;
  return one;
}

Accept::Request asked(const std::string& component, const std::string& topic = "",
                      const std::string& kind = "", bool undo = false) {
  Accept::Request request;
  request.component = component;
  request.topic = topic;
  request.kind = kind;
  request.undo = undo ? 1U : 0U;
  return request;
}

// A robot of a fleet: its names are those of the model but for /r and a number.
class AcceptCallsTest : public testing::Test {
 protected:
  AcceptCallsTest() {
    fs::create_directory(folder_);
    calls_.read(model_);
  }
  ~AcceptCallsTest() override {
    calls_.finish();
    fs::remove_all(folder_);
  }
  AcceptCallsTest(const AcceptCallsTest&) = delete;
  AcceptCallsTest& operator=(const AcceptCallsTest&) = delete;

  /// @return the answer; `success` is what it has to be
  std::string call(const Accept::Request& request, bool success = true) {
    const Accept::Response response = calls_.serve(request, "/rqt");
    EXPECT_EQ(response.success != 0U, success) << response.message;
    return response.message;
  }
  std::string accepted() const { return inWordsOf(calls_.accepted().list()); }
  /// Accepts what stands. @return the answer
  std::string acceptAlarm(bool success = true) {
    Accept::Request request;
    request.alarm = alarm_->id;
    return call(request, success);
  }
  /// An alarm that stands from now on.
  core::Alarm& stands(core::Kind kind, std::vector<core::Suspect> suspects) {
    core::Alarm& alarm = alarm_.emplace();
    alarm.id = 5;
    alarm.kind = kind;
    alarm.culprit = suspects.empty() ? "" : suspects.front().component;
    alarm.suspects = std::move(suspects);
    return alarm;
  }

  static ros1::EncodingRules rules() {
    ros1::EncodingRules rules;
    rules.renames = {{"/r[0-9]+/(.*)", "/\\1"}};
    return rules;
  }

  const fs::path folder_ = fs::temp_directory_path() / fs::unique_path();
  const std::string model_ = (folder_ / "robot.model").string();
  core::Vocabulary vocabulary_{{{"/driver", "/scan", "T"}, {"/base", "/odom", "T"}}};
  ros1::Encoder encoder_{rules(), [](const core::EventType& /*type*/) { return 0; }};
  std::optional<core::Alarm> alarm_;
  self_awareness::Incidents incidents_;
  std::map<core::EventId, std::uint64_t> unknown_;
  int changes_ = 0;
  OperatorCalls admitted_;
  AcceptCalls calls_{admitted_,
                     {[this]() -> std::optional<Acceptable> {
                        return Acceptable{alarm_, incidents_, vocabulary_, unknown_, encoder_, 7};
                      },
                      [this](const std::string& /*caller*/) { ++changes_; }}};
};

TEST_F(AcceptCallsTest, WhatStandsIsTakenByItsIdWhileItStands) {
  stands(core::Kind::kSilent, {suspect(0, "/driver", core::Kind::kSilent),
                               suspect(1, "/base", core::Kind::kLate, false)});
  Accept::Request request;
  request.alarm = 4;
  EXPECT_EQ(call(request, false), "alarm: 4 does not stand any more");
  request.alarm = 5;
  call(request);
  EXPECT_EQ(accepted(), "/driver on /scan (silent)") << "the other one is near its limit only";
  EXPECT_TRUE(calls_.covers(*alarm_, vocabulary_));
  alarm_.reset();
  EXPECT_EQ(call(request, false), "alarm: 5 does not stand any more");
  EXPECT_EQ(changes_, 1);
}

TEST_F(AcceptCallsTest, ADeathIsCoveredByAnAbsenceThatIsAccepted) {
  stands(core::Kind::kSilent, {suspect(0, "/driver", core::Kind::kSilent)});
  call(asked("/driver", "", "never came"));
  EXPECT_TRUE(calls_.covers(*alarm_, vocabulary_));
  stands(core::Kind::kSlow, {suspect(0, "/driver", core::Kind::kSlow)});
  EXPECT_FALSE(calls_.covers(*alarm_, vocabulary_)) << "it is there";
}

TEST_F(AcceptCallsTest, WhatNamesNobodyOrNoKindIsRefused) {
  EXPECT_NE(call(asked("", "", "slow"), false).find("name a component or a topic"),
            std::string::npos);
  EXPECT_NE(call(asked("/a", "", "odd"), false).find("kind: odd is not a kind"),
            std::string::npos);
  Accept::Request request;
  request.incident = 7;
  EXPECT_NE(call(request, false).find("there is none of the id 7"), std::string::npos);
  request.component = "/a";
  EXPECT_NE(call(request, false).find("alone, without component"), std::string::npos);
  EXPECT_EQ(changes_, 0);
}

TEST_F(AcceptCallsTest, ACallThatNamesNothingAcceptsNothingAndTellsWhatMayBeNamed) {
  EXPECT_EQ(call({}, false), "nothing stands, and nobody is new; name a component or a topic");
  stands(core::Kind::kSilent, {suspect(0, "/driver", core::Kind::kSilent)});
  unknown_[1] = 12;
  for (std::uint64_t id = 2; id < 6; ++id) {
    self_awareness::Incident& incident = incidents_.incidents.emplace_back();
    incident.id = incident.last = id;
    incident.kind = id == 2 ? "busy machine" : "silent";
    incident.component = id == 2 ? "" : id == 3 ? "/slam" : "/driver";
  }
  const std::string offers =
      "nothing is accepted, as nothing is named. Give \"{alarm: 5}\" for /driver on /scan "
      "(silent), "
      "\"{component: /base, topic: /odom, kind: stranger}\" for 12 messages of it, "
      "\"{incident: 4}\" for /driver (silent)";
  EXPECT_EQ(call({}, false), offers + ", \"{incident: 3}\" for /slam (silent)");
  call(asked("/slam"));
  EXPECT_EQ(call({}, false), offers) << "what is accepted already is not offered";
  alarm_->culprit.clear();
  EXPECT_NE(call({}, false).find("alarm 5: nobody is to blame for it (silent); name a component"),
            std::string::npos);
  EXPECT_EQ(accepted(), "/slam");
  EXPECT_EQ(changes_, 1);
}

TEST_F(AcceptCallsTest, ACallThatNamesNothingToTakeBackTellsWhatIsAccepted) {
  EXPECT_EQ(call(asked("", "", "", true), false), "nothing is accepted");
  call(asked("/driver", "/scan", "slow"));
  call(asked("/base"));
  EXPECT_EQ(call(asked("", "", "", true), false),
            "name what is to be judged again: /driver on /scan (slow), /base");
}

TEST_F(AcceptCallsTest, WhatIsNobodysFaultIsRefused) {
  for (const core::Kind kind :
       {core::Kind::kAllSilent, core::Kind::kNewMode, core::Kind::kBusyMachine}) {
    core::Alarm& alarm = stands(kind, {suspect(0, "/driver", core::Kind::kSilent),
                                       suspect(1, "/base", core::Kind::kSilent)});
    alarm.culprit.clear();
    const std::string answer = acceptAlarm(false);
    EXPECT_NE(answer.find(core::toString(kind)), std::string::npos) << answer;
    EXPECT_NE(answer.find("name a component"), std::string::npos) << answer;
    call(asked("/driver", "", core::toString(kind)), false);
  }
  EXPECT_EQ(accepted(), "");
}

TEST_F(AcceptCallsTest, AModeIsTakenWhileItStandsOrByItsIncidentAndTakenBack) {
  const std::string words = "/base /camera /driver /imu (new mode)";
  core::Alarm& alarm = stands(core::Kind::kNewMode, {});
  alarm.silent.emplace();
  alarm.silent->others_go_on = true;
  alarm.silent->components = {"/base", "/camera", "/driver", "/imu"};
  EXPECT_FALSE(calls_.covers(alarm, vocabulary_));
  acceptAlarm();
  EXPECT_EQ(accepted(), words);
  EXPECT_TRUE(calls_.covers(alarm, vocabulary_));
  alarm.silent->components.push_back("/other");
  EXPECT_FALSE(calls_.covers(alarm, vocabulary_));
  alarm_.reset();
  ros1::CommunicationState state;
  calls_.tell(vocabulary_.types(), state);
  EXPECT_EQ(state.accepted, std::vector<std::string>{words + ", by /rqt"});
  EXPECT_EQ(state.accepted_of.at("/driver"), words);
  call(asked("/camera", "", "", true));
  EXPECT_EQ(accepted(), "");

  self_awareness::Incident incident;
  incident.id = 3;
  incident.kind = "new mode";
  incidents_.incidents = {incident};
  Accept::Request request;
  request.incident = 3;
  EXPECT_NE(call(request, false).find("not all components that were off are known"),
            std::string::npos);
  incidents_.incidents[0].together = {"/base", "/camera", "/driver", "/imu"};
  call(request);
  EXPECT_EQ(accepted(), words);
  calls_.finish();
  EXPECT_TRUE(ros1::readAccepted(ros1::pathOfAccepted(model_)).value().coversMode({"/imu"}));
  EXPECT_NE(call(asked("/driver", "", "new mode"), false).find("accept it while it stands"),
            std::string::npos);
  request.undo = 1U;
  call(request);
  EXPECT_EQ(accepted(), "");
}

TEST_F(AcceptCallsTest, WhileTheMachineIsBusyOnlyTheCulpritIsTaken) {
  stands(core::Kind::kSilent,
         {suspect(0, "/driver", core::Kind::kSilent), suspect(1, "/base", core::Kind::kLate)})
      .busy = core::Busy();
  acceptAlarm();
  EXPECT_EQ(accepted(), "/driver on /scan (silent)");
}

TEST_F(AcceptCallsTest, OfConnectionsEachTopicIsTaken) {
  std::vector<core::Suspect> deaf{suspect(1, "/base", core::Kind::kUnsubscribed, false)};
  deaf[0].reason.topics = {"/cmd_vel", "/stop"};
  stands(core::Kind::kUnsubscribed, deaf);
  EXPECT_EQ(acceptAlarm().find("nobody of that name"), std::string::npos) << "/base is known";
  EXPECT_EQ(accepted(), "/base on /cmd_vel (not subscribed), /base on /stop (not subscribed)");
  EXPECT_TRUE(calls_.covers(*alarm_, vocabulary_));
  call(asked("/base", "/stop", "", true));
  EXPECT_FALSE(calls_.covers(*alarm_, vocabulary_));
  ros1::CommunicationState state;
  calls_.tell(vocabulary_.types(), state);
  EXPECT_EQ(state.accepted_of.at("/base"), "/base on /cmd_vel (not subscribed)");
}

TEST_F(AcceptCallsTest, OfAnIncidentItsVictimsAreNotTaken) {
  self_awareness::Incident incident;
  incident.id = 3;
  incident.kind = "silent";
  incident.component = "/driver";
  incident.together = {"/base"};
  incident.victims = {"/slam"};
  incidents_.incidents = {incident};
  Accept::Request request;
  request.incident = 3;
  call(request);
  EXPECT_EQ(accepted(), "/driver (silent), /base (silent)");
  call(asked("/*", "", "", true));
  incidents_.incidents[0].kind = "slow";
  call(request);
  EXPECT_EQ(accepted(), "/driver (slow)") << "who fell silent with it is not slow";
  incidents_.incidents[0].component.clear();
  incidents_.incidents[0].kind = "all silent";
  EXPECT_NE(call(request, false).find("nobody is to blame"), std::string::npos);
}

TEST_F(AcceptCallsTest, SeveralAreTakenInOneCall) {
  Accept::Request request;
  request.more = {named("/joystick", "/joy", "stranger"), named("nobody", ""),
                  named("/rqt", "/plot", "stranger")};
  const std::string answer = call(request, false);
  EXPECT_EQ(answer.rfind("2 of 3: normal from now on: /joystick on /joy (stranger), ", 0), 0U)
      << answer;
  EXPECT_NE(answer.find("refused: nobody: component: a name begins with a /"), std::string::npos)
      << answer;
  EXPECT_EQ(accepted(), "/joystick on /joy (stranger), /rqt on /plot (stranger)");
  EXPECT_EQ(changes_, 1);
}

TEST_F(AcceptCallsTest, ThereIsAMostInACallAndInAnAnswer) {
  Accept::Request request;
  for (std::size_t k = 0; k < core::Acceptances::kMost; ++k) {
    request.more.push_back(named("/n" + std::to_string(k), ""));
  }
  EXPECT_LT(call(request).size(), 2000U);
  EXPECT_NE(call(asked("/one_more"), false).find("which is the most"), std::string::npos);
  request.more.push_back(named("/n", ""));
  EXPECT_NE(call(request, false).find("more than 1000"), std::string::npos);
}

TEST_F(AcceptCallsTest, NamesAreCheckedAndAreThoseOfTheModel) {
  for (const std::string& name :
       std::vector<std::string>{"driver", "*", "/dri*er", "/a\x1b", std::string(1001, '/')}) {
    call(asked(name), false);
    call(asked("", name), false);
  }
  EXPECT_EQ(changes_, 0);
  const std::string answer = call(asked("/r7/driver_4242_1600000000000", "/r7/scan", "slow"));
  EXPECT_EQ(accepted(), "/driver on /scan (slow)");
  EXPECT_EQ(answer.find("known yet"), std::string::npos) << answer;
  EXPECT_NE(call(asked("/nobody*")).find("; nobody of that name is known yet: /nobody*"),
            std::string::npos);
  EXPECT_EQ(call(asked("/dri*")).find("known yet"), std::string::npos);
}

TEST_F(AcceptCallsTest, AllThatFitsIsTakenBackAndElseItIsSaidWhatIsAccepted) {
  call(asked("/driver", "/scan", "slow"));
  call(asked("/driver", "", "stale"));
  call(asked("/base"));
  EXPECT_NE(call(asked("/slam", "", "", true), false)
                .find("/slam is not accepted; these are: /driver on /scan (slow), "),
            std::string::npos);
  EXPECT_EQ(call(asked("/driver", "", "", true))
                .rfind("judged again: /driver on /scan (slow), /driver (stale)", 0),
            0U);
  EXPECT_EQ(accepted(), "/base");
  call(asked("/base", "", "", true));
  EXPECT_NE(call(asked("/base", "", "", true), false).find("nothing is"), std::string::npos);
}

TEST_F(AcceptCallsTest, AReloadDoesNotForgetWhatIsNotWrittenYet) {
  const std::string path = ros1::pathOfAccepted(model_);
  fs::create_directory(path);  // so that it cannot be written
  call(asked("/driver", "", "slow"));
  ASSERT_TRUE(await([&] { return !calls_.error().empty(); }));
  calls_.read(model_);
  EXPECT_EQ(accepted(), "/driver (slow)");
  calls_.read((folder_ / "other.model").string());
  EXPECT_EQ(accepted(), "") << "that of another model is another one";
  calls_.read(model_);
  EXPECT_EQ(accepted(), "/driver (slow)");
  fs::remove(path);
  calls_.finish();
  calls_.read(model_);
  EXPECT_EQ(accepted(), "/driver (slow)") << "it is written";
}

}  // namespace
}  // namespace self_awareness
