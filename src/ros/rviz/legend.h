#pragma once

#include "ros/colours.h"

#include <OgreMaterial.h>
#include <OgreTexture.h>

#include <string>
#include <vector>

namespace Ogre {
class Overlay;
class PanelOverlayElement;
}  // namespace Ogre

namespace tissue_ros {

/// What colours mean, in the lower left corner of the view.
class Legend {
 public:
  struct Line {
    Colour colour;
    std::string text;
  };

  /// `name`: of what it makes of Ogre's, which no other may have.
  explicit Legend(const std::string& name);
  ~Legend();
  Legend(const Legend&) = delete;
  Legend& operator=(const Legend&) = delete;

  void show(const std::string& title, const std::vector<Line>& lines);
  void hide();

 private:
  void forget_texture();

  std::string name_;
  Ogre::Overlay* overlay_;
  Ogre::PanelOverlayElement* panel_;
  Ogre::MaterialPtr material_;
  // What is written there now, if anything.
  Ogre::TexturePtr texture_;
};

}  // namespace tissue_ros
