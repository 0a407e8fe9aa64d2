//! `[[sphere]]`, `[[plane]]`, `[[disc]]`, `[[box]]`, `[[cylinder]]`, `[[cone]]`.

use serde::Deserialize;
use whitted::geometry::{Boxed, Cone, Cylinder, Disc, Plane, Shape};
use whitted::math::Vec3d;

use crate::scene::decode::At;
use crate::scene::document::Fault;
use crate::scene::values::{Direction, NotNegative, Point, Positive};

/// A section: its keys, and the name of a material.
macro_rules! sections {
    ($($(#[$doc:meta])* $name:ident $title:literal { $($(#[$key_doc:meta])* $key:ident: $type:ty,)* })*) => {$(
        $(#[$doc])*
        #[derive(Debug, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[cfg_attr(feature = "schema", schemars(rename = $title))]
        #[serde(deny_unknown_fields)]
        pub(in crate::scene) struct $name {
            $($(#[$key_doc])* pub(in crate::scene) $key: $type,)*
            /// The name of its material. Default: "default".
            pub(in crate::scene) material: Option<At<String>>,
        }
    )*};
}

sections! {
    /// A sphere.
    SphereSection "Sphere" {
        /// Its middle.
        center: Point,
        /// Its radius.
        radius: Positive,
    }
    /// An unbounded plane.
    PlaneSection "Plane" {
        /// Any point of the plane.
        point: Point,
        /// The direction of its front side. Default: [0, 1, 0].
        normal: Option<Direction>,
    }
    /// A flat round plate, possibly with a hole.
    DiscSection "Disc" {
        /// Its middle.
        center: Point,
        /// The direction of its front side. Default: [0, 1, 0].
        normal: Option<Direction>,
        /// Its radius.
        radius: Positive,
        /// The radius of its hole. Default: 0.
        inner_radius: Option<NotNegative>,
    }
    /// An axis-aligned box.
    BoxSection "Box" {
        /// The corner with the smallest coordinates.
        min: Point,
        /// The corner with the largest coordinates.
        max: Point,
    }
    /// A round tube.
    CylinderSection "Cylinder" {
        /// The middle of one end.
        base: Point,
        /// The middle of the other end.
        apex: Point,
        /// Its radius.
        radius: Positive,
        /// True if its ends are closed. Default: true.
        capped: Option<bool>,
    }
    /// A cone, or a frustum of one.
    ConeSection "Cone" {
        /// The middle of one end.
        base: Point,
        /// The middle of the other end.
        apex: Point,
        /// The radius at the base.
        base_radius: NotNegative,
        /// The radius at the apex. Default: 0.
        apex_radius: Option<NotNegative>,
        /// True if its ends are closed. Default: true.
        capped: Option<bool>,
    }
}

const UP: Vec3d = Vec3d::new(0.0, 1.0, 0.0);

fn direction(given: Option<Direction>) -> Vec3d {
    given.map_or(UP, |direction| direction.0)
}

impl PlaneSection {
    pub(in crate::scene) fn plane(&self) -> Plane {
        Plane { point: self.point.0, normal: direction(self.normal) }
    }
}

impl At<DiscSection> {
    pub(in crate::scene) fn shape(&self) -> Result<Shape, Fault> {
        let section = &self.value;
        let (radius, inner_radius) = (section.radius.0, section.inner_radius.map_or(0.0, |x| x.0));
        if inner_radius >= radius {
            return Err(Fault::new(self.span.clone(), "the hole of the disc is as large as the disc"));
        }
        let (center, normal) = (section.center.0, direction(section.normal));
        Ok(Shape::Disc(Disc { center, normal, radius, inner_radius }))
    }
}

impl At<BoxSection> {
    pub(in crate::scene) fn shape(&self) -> Result<Shape, Fault> {
        let (lo, hi) = (self.value.min.0, self.value.max.0);
        if lo.zip(hi, |lo, hi| lo > hi).to_array().contains(&true) {
            return Err(Fault::new(self.span.clone(), "a coordinate of \"min\" exceeds that of \"max\""));
        }
        Ok(Shape::Boxed(Boxed { lo, hi }))
    }
}

impl At<CylinderSection> {
    pub(in crate::scene) fn shape(&self) -> Result<Shape, Fault> {
        let CylinderSection { base, apex, radius, capped, .. } = &self.value;
        check_length(self, base, apex)?;
        let capped = capped.unwrap_or(true);
        Ok(Shape::Cylinder(Cylinder { base: base.0, apex: apex.0, radius: radius.0, capped }))
    }
}

impl At<ConeSection> {
    pub(in crate::scene) fn shape(&self) -> Result<Shape, Fault> {
        let ConeSection { base, apex, base_radius, apex_radius, capped, .. } = &self.value;
        check_length(self, base, apex)?;
        let (base_radius, apex_radius) = (base_radius.0, apex_radius.map_or(0.0, |x| x.0));
        let (base, apex, capped) = (base.0, apex.0, capped.unwrap_or(true));
        if base_radius.max(apex_radius) == 0.0 {
            return Err(Fault::new(self.span.clone(), "both radii of the cone are 0"));
        }
        Ok(match base_radius == apex_radius {
            true => Shape::Cylinder(Cylinder { base, apex, radius: base_radius, capped }),
            false => Shape::Cone(Cone { base, apex, base_radius, apex_radius, capped }),
        })
    }
}

/// Refuse a tube or cone whose ends are in one place.
fn check_length<T>(section: &At<T>, base: &Point, apex: &Point) -> Result<(), Fault> {
    if base.0 == apex.0 {
        return Err(Fault::new(section.span.clone(), "\"base\" and \"apex\" are the same point"));
    }
    Ok(())
}
