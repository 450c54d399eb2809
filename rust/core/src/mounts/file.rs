//! The entry of an engine file for a body and its mounts.

use serde::{Deserialize, Serialize};

use super::{
    DIRECTIONS, InertiaTrack, Mount, MountFigures, Orientation, Powertrain, Products, Receiver,
    Receptance, RigidBody, Support, Table,
};
use crate::Complex64;
use crate::numbers::error::{Error, Result};
use crate::numbers::limits;

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub(crate) struct PowertrainEntry {
    body: BodyEntry,
    mounts: Vec<MountEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    subframe: Option<SubframeEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    receptance: Option<ReceptanceEntry>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct SubframeEntry {
    body: BodyEntry,
    mounts: Vec<MountEntry>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct ReceptanceEntry {
    coordinates: Vec<[String; 2]>,
    frequency: Vec<f64>,
    real: Vec<Vec<Vec<f64>>>,
    imaginary: Vec<Vec<Vec<f64>>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    receivers: Vec<ReceiverEntry>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct ReceiverEntry {
    name: String,
    real: Vec<Vec<[f64; 3]>>,
    imaginary: Vec<Vec<[f64; 3]>>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct BodyEntry {
    mass: f64,
    cg: [f64; 3],
    inertia: [[f64; 3]; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    products: Option<String>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct MountEntry {
    name: String,
    at: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tilt_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    axes: Option<[[f64; 3]; 3]>,
    stiffness: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    dynamic_stiffness: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "is_zero")]
    loss_factor: [f64; 3],
    #[serde(default, skip_serializing_if = "is_zero")]
    damping: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    track: Option<InertiaTrack>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    table: Option<TableEntry>,
}

#[derive(Serialize, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
struct TableEntry {
    frequency: Vec<f64>,
    real: Vec<[f64; 3]>,
    imaginary: Vec<[f64; 3]>,
}

fn is_zero(values: &[f64; 3]) -> bool {
    *values == [0.0; 3]
}

impl Products {
    /// The convention of a name.
    pub fn named(name: &str) -> Result<Self> {
        match name {
            "tensor" => Ok(Self::Tensor),
            "positive-integrals" => Ok(Self::PositiveIntegrals),
            other => {
                let hint =
                    "give \"tensor\" for -∫xy dm off the diagonal, or \"positive-integrals\"";
                Err(Error::value("products", format!("{other:?}"), hint))
            }
        }
    }
}

impl PowertrainEntry {
    pub fn of(powertrain: &Powertrain) -> Self {
        let (subframe, receptance) = match powertrain.support() {
            None => (None, None),
            Some(Support::Subframe(subframe)) => {
                let (body, mounts) = (BodyEntry::of(subframe.body()), mount_entries(subframe));
                (Some(SubframeEntry { body, mounts }), None)
            }
            Some(Support::Receptance(receptance)) => (None, Some(ReceptanceEntry::of(receptance))),
        };
        let (body, mounts) = (BodyEntry::of(powertrain.body()), mount_entries(powertrain));
        Self { body, mounts, subframe, receptance }
    }

    pub fn powertrain(self) -> Result<Powertrain> {
        let powertrain = on_mounts(self.body, self.mounts, "powertrain.")?;
        let support = match (self.subframe, self.receptance) {
            (None, None) => return Ok(powertrain),
            (Some(_), Some(_)) => {
                let hint = "is given beside a receptance: leave out one of them";
                return Err(Error::value("powertrain.subframe", "a table", hint));
            }
            (Some(SubframeEntry { body, mounts }), None) => {
                Support::Subframe(Box::new(on_mounts(body, mounts, "powertrain.subframe.")?))
            }
            (None, Some(receptance)) => {
                let receptance = receptance.receptance();
                let within = |error: Error| error.within("powertrain.receptance.");
                Support::Receptance(receptance.map_err(within)?)
            }
        };
        powertrain.on(support).map_err(|error| error.within("powertrain."))
    }
}

fn on_mounts(body: BodyEntry, mounts: Vec<MountEntry>, place: &str) -> Result<Powertrain> {
    let BodyEntry { mass, cg, inertia, products } = body;
    let products = products.map(|name| Products::named(&name)).transpose();
    let body = products.and_then(|products| RigidBody::new(mass, cg, inertia, products));
    let body = body.map_err(|error| error.within(&format!("{place}body.")))?;
    let mount = |(k, entry): (usize, MountEntry)| {
        let mount = entry.figures().and_then(Mount::new);
        mount.map_err(|error| error.within(&format!("{place}mounts[{k}].")))
    };
    let mounts = mounts.into_iter().enumerate().map(mount).collect::<Result<_>>()?;
    Powertrain::new(body, mounts).map_err(|error| error.within(place))
}

fn mount_entries(powertrain: &Powertrain) -> Vec<MountEntry> {
    powertrain.mounts().iter().map(|mount| MountEntry::of(mount.figures())).collect()
}

impl BodyEntry {
    fn of(body: &RigidBody) -> Self {
        let inertia = body.inertia();
        let has_products = inertia != nalgebra::Matrix3::from_diagonal(&inertia.diagonal());
        Self {
            mass: body.mass(),
            cg: body.cg().into(),
            inertia: [0, 1, 2].map(|i| [0, 1, 2].map(|j| inertia[(i, j)])),
            products: has_products.then(|| "tensor".into()),
        }
    }
}

impl ReceptanceEntry {
    fn of(receptance: &Receptance) -> Self {
        let count = receptance.coordinates.len();
        let parts = |part: fn(&Complex64) -> f64| {
            let rows = |matrix: &Vec<Complex64>| {
                matrix.chunks(count).map(|row| row.iter().map(part).collect()).collect()
            };
            receptance.values.iter().map(rows).collect()
        };
        let receiver = |receiver: &Receiver| {
            let parts = |part: fn(&Complex64) -> f64| {
                let rows = |row: &Vec<[Complex64; 3]>| {
                    row.iter().map(|moved| moved.each_ref().map(part)).collect()
                };
                receiver.transfer.iter().map(rows).collect()
            };
            let name = receiver.name.clone();
            ReceiverEntry { name, real: parts(|h| h.re), imaginary: parts(|h| h.im) }
        };
        let coordinates = receptance.coordinates.iter();
        Self {
            coordinates: coordinates
                .map(|(name, axis)| [name.clone(), DIRECTIONS[*axis].into()])
                .collect(),
            frequency: receptance.frequency.clone(),
            real: parts(|h| h.re),
            imaginary: parts(|h| h.im),
            receivers: receptance.receivers.iter().map(receiver).collect(),
        }
    }

    fn receptance(self) -> Result<Receptance> {
        let coordinates = self.coordinates.into_iter().enumerate().map(|(k, [name, axis])| {
            let place = DIRECTIONS.iter().position(|direction| *direction == axis);
            place.map(|place| (name, place)).ok_or_else(|| {
                let hint = "give \"x\", \"y\" or \"z\"";
                Error::value(format!("coordinates[{k}][1]"), format!("{axis:?}"), hint)
            })
        });
        let coordinates = coordinates.collect::<Result<Vec<_>>>()?;
        let values = joined(&self.real, &self.imaginary, "real", |re, im| Complex64::new(*re, *im));
        let mut receivers = Vec::new();
        for (k, entry) in self.receivers.into_iter().enumerate() {
            let place = format!("receivers[{k}].real");
            let transfer = joined_rows(&entry.real, &entry.imaginary, &place, |re, im| {
                [0, 1, 2].map(|axis| Complex64::new(re[axis], im[axis]))
            })?;
            receivers.push(Receiver { name: entry.name, transfer });
        }
        Receptance { coordinates, frequency: self.frequency, values: values?, receivers }.checked()
    }
}

/// Real and imaginary parts of matrices as complex numbers, their rows one after the other.
fn joined<T, U>(
    real: &[Vec<Vec<T>>],
    imaginary: &[Vec<Vec<T>>],
    place: &str,
    join: impl Fn(&T, &T) -> U,
) -> Result<Vec<Vec<U>>> {
    let same = |found, expected| {
        limits::same_length("imaginary", found, place, expected, "frequency and coordinate")
    };
    same(imaginary.len(), real.len())?;
    let matrix = |(real, imaginary): (&Vec<Vec<T>>, &Vec<Vec<T>>)| {
        joined_rows(real, imaginary, place, &join).map(|rows| rows.into_iter().flatten().collect())
    };
    real.iter().zip(imaginary).map(matrix).collect()
}

/// Real and imaginary parts of rows as complex numbers.
fn joined_rows<T, U>(
    real: &[Vec<T>],
    imaginary: &[Vec<T>],
    place: &str,
    join: impl Fn(&T, &T) -> U,
) -> Result<Vec<Vec<U>>> {
    let same = |found, expected| {
        limits::same_length("imaginary", found, place, expected, "frequency and coordinate")
    };
    same(imaginary.len(), real.len())?;
    let row = |(real, imaginary): (&Vec<T>, &Vec<T>)| {
        same(imaginary.len(), real.len())?;
        Ok(real.iter().zip(imaginary).map(|(re, im)| join(re, im)).collect())
    };
    real.iter().zip(imaginary).map(row).collect()
}

impl MountEntry {
    fn of(figures: &MountFigures) -> Self {
        let (tilt_deg, axes) = match figures.orientation {
            Orientation::Tilt(0.0) => (None, None),
            Orientation::Tilt(degrees) => (Some(degrees), None),
            Orientation::Axes(axes) => (None, Some(axes)),
        };
        let table = figures.table.as_ref().map(|table| {
            let parts = |part: fn(&Complex64) -> f64| {
                table.stiffness.iter().map(|along| along.each_ref().map(part)).collect()
            };
            let frequency = table.frequency.clone();
            TableEntry { frequency, real: parts(|k| k.re), imaginary: parts(|k| k.im) }
        });
        Self {
            name: figures.name.clone(),
            at: figures.at,
            tilt_deg,
            axes,
            stiffness: figures.stiffness,
            dynamic_stiffness: figures.dynamic_stiffness,
            loss_factor: figures.loss_factor,
            damping: figures.damping,
            track: figures.track,
            table,
        }
    }

    fn figures(self) -> Result<MountFigures> {
        let orientation = match (self.tilt_deg, self.axes) {
            (Some(degrees), Some(_)) => {
                let hint = "is given beside axes: leave out one of them";
                return Err(Error::figure("tilt_deg", degrees, hint));
            }
            (degrees, None) => Orientation::Tilt(degrees.unwrap_or(0.0)),
            (None, Some(axes)) => Orientation::Axes(axes),
        };
        let table = |TableEntry { frequency, real, imaginary }: TableEntry| {
            let (name, of) = ("table.imaginary", "table.real");
            limits::same_length(name, imaginary.len(), of, real.len(), "frequency")?;
            let complex = |(re, im): ([f64; 3], [f64; 3])| {
                [0, 1, 2].map(|axis| Complex64::new(re[axis], im[axis]))
            };
            Ok(Table {
                frequency,
                stiffness: real.into_iter().zip(imaginary).map(complex).collect(),
            })
        };
        Ok(MountFigures {
            name: self.name,
            at: self.at,
            orientation,
            stiffness: self.stiffness,
            dynamic_stiffness: self.dynamic_stiffness,
            loss_factor: self.loss_factor,
            damping: self.damping,
            track: self.track,
            table: self.table.map(table).transpose()?,
        })
    }
}
