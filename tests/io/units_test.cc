#include "io/read/units.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "base/units.h"

namespace hindsight {
namespace {

struct Case {
  const char* text;
  Quantity quantity;
  double si;
};

TEST(Units, ConvertToSi) {
  const Case cases[] = {
      {"0.23 deg/sqrt(h)", Quantity::kGyroNoiseDensity,
       0.23 * kPi / 180.0 / 60.0},
      {"1 deg/s/sqrt(Hz)", Quantity::kGyroNoiseDensity, kPi / 180.0},
      {"60 deg/h/sqrt(Hz)", Quantity::kGyroNoiseDensity, kPi / 180.0 / 60.0},
      {"2 rad/sqrt(s)", Quantity::kGyroNoiseDensity, 2.0},
      {"70 ug/sqrt(Hz)", Quantity::kAccelNoiseDensity, 70e-6 * 9.80665},
      {"0.6 m/s/sqrt(h)", Quantity::kAccelNoiseDensity, 0.01},
      {"0.5 m/s^2/sqrt(Hz)", Quantity::kAccelNoiseDensity, 0.5},
      {"3.8e-5 deg/s^2/sqrt(Hz)", Quantity::kGyroBiasWalk,
       3.8e-5 * kPi / 180.0},
      {"3600 deg/h/sqrt(h)", Quantity::kGyroBiasWalk, kPi / 180.0 / 60.0},
      {"7 ug/s/sqrt(Hz)", Quantity::kAccelBiasWalk, 7e-6 * 9.80665},
      {"6 mg/sqrt(h)", Quantity::kAccelBiasWalk, 1e-4 * 9.80665},
      {"1 mg", Quantity::kAcceleration, 9.80665e-3},
      {"10 mGal", Quantity::kAcceleration, 1e-4},
      {"5 ppm", Quantity::kRatio, 5e-6},
      {"0.1 %", Quantity::kRatio, 1e-3},
      {"3 deg/h", Quantity::kAngularRate, kPi / 180.0 / 1200.0},
      {"20 ms", Quantity::kTime, 0.02},
      {"-12.3 deg", Quantity::kAngle, -12.3 * kPi / 180.0},
      {"36 km/h", Quantity::kSpeed, 10.0},
      {"1 kn", Quantity::kSpeed, 1852.0 / 3600.0},
      {"+20 cm", Quantity::kLength, 0.2},
      {"100 Hz", Quantity::kFrequency, 100.0},
      {"50 nT", Quantity::kMagneticField, 0.05},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    EXPECT_NEAR(ParseQuantity(c.text, c.quantity), c.si,
                1e-14 * std::abs(c.si));
  }
}

TEST(Units, DataSheetsAreReadAsTheyAreWritten) {
  const double degree = kPi / 180.0;
  const Case cases[] = {
      {"2 dps", Quantity::kAngularRate, 2.0 * degree},
      {"61 mdps", Quantity::kAngularRate, 0.061 * degree},
      {"5 \u00b0/s", Quantity::kAngularRate, 5.0 * degree},
      {"0.007 dps/\u221aHz", Quantity::kGyroNoiseDensity, 0.007 * degree},
      {"3.8 mdps/\u221aHz", Quantity::kGyroNoiseDensity, 3.8e-3 * degree},
      {"0.0028 \u00b0/s/rtHz", Quantity::kGyroNoiseDensity, 0.0028 * degree},
      {"0.15 \u00b0/\u221ah", Quantity::kGyroNoiseDensity,
       0.15 * degree / 60.0},
      {"0.15 deg per sqrt(hr)", Quantity::kGyroNoiseDensity,
       0.15 * degree / 60.0},
      {"0.01 (deg/s)/sqrtHz", Quantity::kGyroNoiseDensity, 0.01 * degree},
      {"60 \u00b5g/\u221aHz", Quantity::kAccelNoiseDensity, 60e-6 * 9.80665},
      {"60 \u03bcg/Hz^0.5", Quantity::kAccelNoiseDensity, 60e-6 * 9.80665},
      {"0.6 m/s/\u221ahr", Quantity::kAccelNoiseDensity, 0.01},
      {"60 \u00b5g/rt(Hz)", Quantity::kAccelNoiseDensity, 60e-6 * 9.80665},
      {"60 \u03bcg/rt(Hz)", Quantity::kAccelNoiseDensity, 60e-6 * 9.80665},
      {"0.15 deg/rt-hr", Quantity::kGyroNoiseDensity, 0.15 * degree / 60.0},
      {"0.15 deg/root(h)", Quantity::kGyroNoiseDensity, 0.15 * degree / 60.0},
      {"0.15 deg/sqrt(hr)", Quantity::kGyroNoiseDensity, 0.15 * degree / 60.0},
      {"0.15 deg/root hour", Quantity::kGyroNoiseDensity, 0.15 * degree / 60.0},
      {"9.81 m/s2", Quantity::kAcceleration, 9.81},
      {"9.81 m/s\u00b2", Quantity::kAcceleration, 9.81},
      {"3 degrees", Quantity::kAngle, 3.0 * degree},
      {"2 sec", Quantity::kTime, 2.0},
      {"40 microtesla", Quantity::kMagneticField, 40.0},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    EXPECT_NEAR(ParseQuantity(c.text, c.quantity), c.si,
                1e-14 * std::abs(c.si));
  }
}

TEST(Units, EverySiUnitIsAcceptedWithFactorOne) {
  for (int i = 0; i <= static_cast<int>(Quantity::kMagneticField); ++i) {
    const auto quantity = static_cast<Quantity>(i);
    SCOPED_TRACE(SiUnit(quantity));
    EXPECT_EQ(UnitFactor(SiUnit(quantity), quantity), 1.0);
  }
}

TEST(Units, RefuseWhatIsMissingOrOfAnotherDimension) {
  const Case cases[] = {
      {"0.23", Quantity::kGyroNoiseDensity, 0},
      {"0", Quantity::kLength, 0},
      {"0.23 deg/h", Quantity::kGyroNoiseDensity, 0},
      {"1 deg", Quantity::kRatio, 0},
      {"1 m", Quantity::kTime, 0},
      {"1 furlong", Quantity::kLength, 0},
      {"m", Quantity::kLength, 0},
      {"nan m", Quantity::kLength, 0},
      {"inf m", Quantity::kLength, 0},
      {"1.2.3 m", Quantity::kLength, 0},
      {"1 m/", Quantity::kLength, 0},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    try {
      ParseQuantity(c.text, c.quantity);
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(UnitExamples(c.quantity)),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(Units, MessagesPutTheRightArticle) {
  const auto message = [](Quantity quantity) -> std::string {
    try {
      ParseQuantity("1 furlong", quantity);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const std::string angle = message(Quantity::kAngle);
  EXPECT_NE(angle.find("not one of an angle"), std::string::npos) << angle;
  EXPECT_NE(angle.find("expected an angle"), std::string::npos) << angle;
  const std::string length = message(Quantity::kLength);
  EXPECT_NE(length.find("not one of a length"), std::string::npos) << length;
}

TEST(Units, ListsShareTheirLastUnit) {
  const std::vector<double> expected = {0.0, 0.5, -1.1};
  for (const char* text : {"[0, 0.5, -1.1] m", "0, 0.5, -1.1 m",
                           "[0 m, 0.5 m, -1.1 m]", "0 m, 50 cm, -1.1 m"}) {
    SCOPED_TRACE(text);
    EXPECT_EQ(ParseQuantities(text, Quantity::kLength), expected);
  }
  EXPECT_THROW(ParseQuantities("[0, 0.5, -1.1]", Quantity::kLength),
               std::invalid_argument);
}

/// Of a column; a value has its number already.
TEST(Units, OfColumnsMayBeMultiples) {
  EXPECT_DOUBLE_EQ(*UnitFactor("0.1 ms", Quantity::kTime), 1e-4);
  EXPECT_DOUBLE_EQ(*UnitFactor("1e-7deg", Quantity::kAngle), 1e-7 * kDegree);
  EXPECT_DOUBLE_EQ(*UnitFactor("0.01 km/h", Quantity::kSpeed), 0.01 / 3.6);
  EXPECT_FALSE(UnitFactor("0 ms", Quantity::kTime));
  EXPECT_FALSE(UnitFactor("-1 ms", Quantity::kTime));
  EXPECT_FALSE(UnitFactor("2 3 ms", Quantity::kTime));
  EXPECT_FALSE(UnitFactor("2 m", Quantity::kTime));
  EXPECT_THROW(ParseQuantity("1 2 m", Quantity::kLength),
               std::invalid_argument);
}

}  // namespace
}  // namespace hindsight
