//! Meshes in files of other programs: written files are read back, by us and by others; damaged ones get an
//! answer.

use std::process::Command;

use stribeck_mesh::decks::radioss::{Motion, Touching};
use stribeck_mesh::decks::{ContactPair, Deck, Model, Side, Step};
use stribeck_mesh::{Annulus, Disc, Groove, Mesh, Part, Rectangle};
use stribeck_testing::{
    Noise, Scratch,
    peer::{absent, python_with},
    said, says,
};

const ALL: [(Deck, &str); 2] = [(Deck::Abaqus, "inp"), (Deck::Gmsh, "msh")];

/// A ring with a groove, of quadrilaterals, and a disc, which has triangles.
fn mesh() -> Mesh {
    let ring = Annulus {
        inner_radius: 0.02,
        outer_radius: 0.025,
        facets: 120,
        layers: 4,
        start_angle: 0.1,
        grooves: vec![Groove::rectangular(1.5, 4e-3, 0.5e-3)],
    };
    let mut mesh = Mesh::new();
    mesh.add("outer ring", &ring.part().expect("a ring"));
    mesh.add(
        "roller 1",
        &Disc { radius: 4e-3, facets: 40, size: 6e-4, rotation: 0.2 }.part().expect("a disc"),
    );
    mesh
}

#[test]
fn roundtrip_places_corners_bodies_and_sets() {
    let mesh = mesh();
    for (deck, extension) in ALL {
        assert_eq!(Deck::of_extension(extension), Some(deck));
        let read = deck.read(&deck.write(&mesh, "a bearing")).unwrap_or_else(|e| panic!("{extension}: {e}"));
        let back = &read.mesh;
        assert_eq!((back.x.len(), back.elements()), (mesh.x.len(), mesh.elements()), "{extension}");
        assert!(read.notes.is_empty(), "{extension}: {:?}", read.notes);
        for (ours, theirs) in mesh.bodies.iter().zip(&back.bodies) {
            let plain = |name: &str| name.to_uppercase().replace(' ', "_");
            assert_eq!(plain(&ours.name), plain(&theirs.name), "{extension}");
            assert_eq!(
                (ours.quads.clone(), ours.triangles.clone()),
                (theirs.quads.clone(), theirs.triangles.clone())
            );
        }
        // Numbers of nodes may differ, places may not: to the last bit, each corner where it was. Abaqus
        // reads twenty characters of a number, which hold fourteen digits at least.
        let exact = deck != Deck::Abaqus;
        let same = |a: f64, b: f64| {
            if exact { a.to_bits() == b.to_bits() } else { (a - b).abs() <= 1e-13 * a.abs() }
        };
        let corners = |m: &Mesh| -> Vec<u32> {
            m.quads.iter().flatten().chain(m.triangles.iter().flatten()).copied().collect()
        };
        for (ours, theirs) in corners(&mesh).into_iter().zip(corners(back)) {
            let (ours, theirs) = (ours as usize, theirs as usize);
            assert!(
                same(mesh.x[ours], back.x[theirs]) && same(mesh.y[ours], back.y[theirs]),
                "{extension}: {ours}"
            );
        }
        let text = deck.write(&mesh, "");
        let items = || text.lines().flat_map(|line| line.split(", "));
        assert!(exact || items().all(|item| item.starts_with('*') || item.contains('=') || item.len() <= 20));
        if deck != Deck::Gmsh {
            let sizes: Vec<usize> = read.node_sets.values().map(Vec::len).collect();
            assert_eq!(sizes, mesh.bodies.iter().map(|b| b.nodes.len()).collect::<Vec<_>>(), "{extension}");
        }
    }
}

/// A ring and a disc of steel that may touch.
fn model(mesh: &Mesh) -> Model<'_> {
    Model {
        mesh,
        youngs_modulus: 2.1e11,
        poissons_ratio: 0.3,
        density: 7850.0,
        thickness: 0.02,
        rigid: vec![1],
        contacts: vec![ContactPair { surfaces: [(1, Side::Outside), (0, Side::Inside)], friction: 0.1 }],
        step: None,
    }
}

/// Material, sections and contacts stand beside the same mesh, surfaces are closed lines of its boundary, and
/// what the reader does not support is named.
#[test]
fn roundtrip_a_model() {
    let mesh = mesh();
    let deck = Deck::Abaqus;
    let text = deck.write_model(&model(&mesh), "a bearing");
    let read = deck.read(&text).unwrap_or_else(|e| panic!("{e}"));
    let plain = deck.read(&deck.write(&mesh, "a bearing")).expect("a mesh");
    assert_eq!(read.mesh, plain.mesh);
    assert!(read.notes.iter().any(|note| note.contains("CONTACT")), "{:?}", read.notes);
    for card in [
        "*SOLID SECTION, ELSET=ROLLER_1, MATERIAL=ELASTIC\n0.02",
        "*FRICTION\n0.1",
        "\nROLLER_1_OUTSIDE, OUTER_RING_INSIDE",
    ] {
        assert!(text.contains(card), "`{card}` is not there");
    }
    // The disc has forty facets, the ring's back 120; its raceway has the groove's walls, too.
    let [disc, inside, outside] =
        ["NODES_ROLLER_1_OUTSIDE", "NODES_OUTER_RING_INSIDE", "NODES_OUTER_RING_OUTSIDE"].map(|name| {
            let nodes = read.node_sets.get(name).unwrap_or_else(|| panic!("no `{name}`"));
            nodes.iter().map(|&n| read.mesh.x[n as usize].hypot(read.mesh.y[n as usize])).collect::<Vec<_>>()
        });
    assert_eq!((disc.len(), outside.len()), (40, 120));
    assert!(disc.iter().all(|r| (r - 4e-3).abs() < 1e-12));
    assert!(outside.iter().all(|r| (r - 0.025).abs() < 1e-12));
    assert!(inside.len() > 119 && inside.iter().all(|r| *r < 0.0206));
}

/// A free ring as CalculiX computes it from our file: three motions without frequency, then pairs of bending
/// modes. Source: Love (1927), thin ring in plane strain, ω² = E' h² n² (n² − 1)² / (12 ρ R⁴ (n² + 1)), E' =
/// E/(1 − ν²); what shear and four nodes of reduced integration leave is below 3 % in a ring of R/h = 20 with
/// eight layers.
#[test]
fn peer_calculix_finds_the_frequencies_of_a_ring() {
    if Command::new("ccx").arg("-v").output().is_err() {
        return absent("STRIBECK_NEED_CALCULIX", "there is no `ccx`").unwrap_or_default();
    }
    let ring = Annulus {
        inner_radius: 0.0975,
        outer_radius: 0.1025,
        facets: 720,
        layers: 8,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let mut mesh = Mesh::new();
    mesh.add("outer ring", &ring.part().expect("a ring"));
    let model = Model { rigid: Vec::new(), contacts: Vec::new(), ..model(&mesh) };
    let folder = Scratch::create("calculix");
    let text = Deck::Abaqus.write_model(&model, "a ring") + "*STEP\n*FREQUENCY\n9\n*END STEP\n";
    std::fs::write(folder.join("ring.inp"), text).expect("it is written");
    let output = Command::new("ccx").current_dir(folder.path()).arg("ring").output().expect("it starts");
    let listed =
        std::fs::read_to_string(folder.join("ring.dat")).unwrap_or_else(|_| panic!("{}", said(&output)));
    // Number, eigenvalue, frequency in rad and in periods a time, and the imaginary part.
    let hz: Vec<f64> = listed
        .lines()
        .map(|line| line.split_whitespace().filter_map(|word| word.parse().ok()).collect::<Vec<f64>>())
        .filter(|numbers| numbers.len() == 5)
        .map(|numbers| numbers[3])
        .take(9)
        .collect();
    let love = |n: f64| {
        let (radius, height) = (0.1_f64, 0.005_f64);
        let stiff = 2.1e11 / (1.0 - 0.09) * height.powi(2) / (12.0 * 7850.0 * radius.powi(4));
        (stiff * (n * (n * n - 1.0)).powi(2) / (n * n + 1.0)).sqrt() / std::f64::consts::TAU
    };
    assert!(hz[..3].iter().all(|hz| *hz < 0.1 * love(2.0)), "{hz:?}");
    for (pair, n) in hz[3..].chunks_exact(2).zip([2.0, 3.0, 4.0]) {
        println!("{n}: {pair:.2?} Hz, thin ring {:.2} Hz", love(n));
        assert!(pair.iter().all(|hz| (hz / love(n) - 1.0).abs() < 0.03), "{n}: {hz:?}, {}", love(n));
    }
}

/// A free disc that flies, falls and is pushed, for two milliseconds.
fn flight(mesh: &Mesh) -> Step {
    Step {
        duration: 2e-3,
        gravity: [0.0, -9.81],
        load: ((0..mesh.x.len() as u32).collect(), [300.0, -40.0]),
        velocity: vec![[0.5, 0.25]; mesh.x.len()],
        left_out: vec!["the wind".to_owned()],
        ..Step::default()
    }
}

/// Loads, weight and velocities of a step as CalculiX takes them from our file.
/// Source: Newton (1687), x = v t + ½ (F/m + g) t² for the mean of all nodes of a free body, weighted by
/// mass; half a per cent for the mean over nodes.
#[test]
fn peer_calculix_lets_a_disc_fly() {
    if Command::new("ccx").arg("-v").output().is_err() {
        return absent("STRIBECK_NEED_CALCULIX", "there is no `ccx`").unwrap_or_default();
    }
    let mut mesh = Mesh::new();
    let disc = Disc { radius: 4e-3, facets: 40, size: 6e-4, rotation: 0.2 }.part().expect("a disc");
    let mass = 7850.0 * 0.02 * disc.area();
    mesh.add("roller 1", &disc);
    let step = flight(&mesh);
    let model = Model { rigid: Vec::new(), contacts: Vec::new(), step: Some(step.clone()), ..model(&mesh) };
    let folder = Scratch::create("flight");
    let text = Deck::Abaqus
        .write_model(&model, "a disc")
        // Implicit, because explicit steps of the mesh's size are more than it takes.
        .replace("*DYNAMIC, EXPLICIT\n, 2e-3", "*DYNAMIC\n2e-5, 2e-3")
        .replace("*END STEP", "*NODE PRINT, NSET=NODES_ROLLER_1, FREQUENCY=100000\nU\n*END STEP");
    std::fs::write(folder.join("disc.inp"), text).expect("it is written");
    let output = Command::new("ccx").current_dir(folder.path()).arg("disc").output().expect("it starts");
    let listed =
        std::fs::read_to_string(folder.join("disc.dat")).unwrap_or_else(|_| panic!("{}", said(&output)));
    let moved: Vec<Vec<f64>> = listed
        .lines()
        .map(|line| line.split_whitespace().filter_map(|word| word.parse().ok()).collect::<Vec<f64>>())
        .filter(|numbers| numbers.len() == 4)
        .collect();
    let last = &moved[moved.len() - mesh.x.len()..];
    for axis in 0..2 {
        let mean = last.iter().map(|numbers| numbers[1 + axis]).sum::<f64>() / last.len() as f64;
        let (t, a) = (step.duration, step.load.1[axis] / mass + step.gravity[axis]);
        let flown = step.velocity[0][axis] * t + 0.5 * a * t * t;
        println!("axis {axis}: {:.4} mm, by Newton {:.4} mm", 1e3 * mean, 1e3 * flown);
        assert!((mean / flown - 1.0).abs() < 5e-3, "{mean} {flown}\n{}", said(&output));
    }
}

/// What is done to bodies stands in the file, and leaves the mesh as it is.
#[test]
fn roundtrip_a_step() {
    let mesh = mesh();
    let step = Step { guided: vec![0, 1], turning: vec![(vec![2, 3], -50.0)], ..flight(&mesh) };
    let deck = Deck::Abaqus;
    let text = deck.write_model(&Model { step: Some(step), ..model(&mesh) }, "a bearing");
    let read = deck.read(&text).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(read.mesh, deck.read(&deck.write(&mesh, "a bearing")).expect("a mesh").mesh);
    for card in [
        "** left out: the wind",
        "TIE NSET=TURNING_1",
        "\nGUIDED, 1, 1",
        ", 6, 6, -5e1",
        "*DYNAMIC, EXPLICIT\n, 2e-3",
        "ROLLER_1, GRAV, 9.81, 0, -1, 0.0",
    ] {
        assert!(text.contains(card), "`{card}` is not there");
    }
    assert_eq!(flight(&mesh).load.0.len(), mesh.x.len());
}

#[test]
fn behaves_files_of_other_hands() {
    // Clockwise, with nodes of an element on two lines.
    let inp = "*Node\n 10, 0, 0\n 20, 0, 1.\n 30, 1, 1\n 40, 1, 0\n** c\n*Element, type=CPS4, elset=Block\n \
        5, 10, 20,\n 30, 40\n*Nset, nset=Left\n 10, 20\n*Material, name=steel\n";
    let read = Deck::Abaqus.read(inp).expect("a mesh");
    let corners = read.mesh.quads[0].map(|n| (read.mesh.x[n as usize], read.mesh.y[n as usize]));
    assert_eq!(corners, [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]);
    assert_eq!(read.node_sets["Left"].len(), 2);
    assert_eq!(read.notes, ["line 12: `*MATERIAL` is not read"]);
}

#[test]
fn refuses_what_is_no_plane_mesh_with_its_line() {
    for (deck, text, line, says) in [
        (Deck::Abaqus, "*NODE\n1, 0, 0\n*ELEMENT, TYPE=C3D8\n", 3, "C3D8"),
        (Deck::Abaqus, "*NODE\n1, 0, x\n", 2, "`x` is no number"),
        (Deck::Abaqus, "*NODE\n1, 0, 0\n2, 1, 0\n*ELEMENT, TYPE=CPE3\n1, 1, 2, 9\n", 5, "no node 9"),
        (Deck::Abaqus, "", 1, "no plane element"),
        (Deck::Abaqus, "*NODE\n1,0,0,5\n", 2, "z = 5"),
        (Deck::Gmsh, "$MeshFormat\n1 0 8\n", 2, "msh41"),
        (Deck::Gmsh, "$MeshFormat\n4.1 1 8\n", 2, "ends in the middle"),
        (Deck::Abaqus, "*NODE\n*SYSTEM\n0, 0, 1\n", 2, "`*SYSTEM` is not read"),
        (Deck::Abaqus, "*NODE, SYSTEM=C\n1, 0, 0\n", 1, "SYSTEM=C"),
        (Deck::Abaqus, "*INCLUDE, INPUT=x.inp\n", 1, "`*INCLUDE, INPUT=x.inp`"),
        (
            Deck::Abaqus,
            "*NODE\n1, 0, 0\n*Element, type=CPE3,\n input=\"e 1.txt\"\n",
            3,
            "`*ELEMENT, INPUT=e 1.txt`",
        ),
        (
            Deck::Abaqus,
            "*NODE\n1, 0, 0\n*ELEMENT, TYPE=CPE8R\n",
            3,
            "8 nodes: mesh with elements of first order",
        ),
        (Deck::Abaqus, "*NODE\n1, 0, 0\n1, 1, 0\n", 3, "was at (0, 0) before"),
        (Deck::Gmsh, "hello\n", 1, "Gmsh"),
        (Deck::Gmsh, "$Nodes\n1 1 1 1\n", 2, "ends in the middle"),
    ] {
        let why = deck.read(text).expect_err(text);
        assert_eq!(why.line, line, "{text}: {why}");
        assert!(why.to_string().contains(says), "{text}: {why}");
    }
}

#[test]
fn survives_damaged_files() {
    const EACH: usize = 1500;
    let mesh = mesh();
    let mut noise = Noise::new(5);
    for (deck, extension) in ALL {
        let whole = deck.write(&mesh, "a bearing").into_bytes();
        for n in 0..EACH {
            let mut bytes = whole.clone();
            let mut place = |of: usize| ((0.5 * (noise.uniform() + 1.0) * of as f64) as usize).min(of - 1);
            for k in 0..4 {
                let at = if k % 2 == 0 { place(300) } else { place(bytes.len()) };
                bytes[at] = b"0123456789-*$,. e\nx"[place(19)];
            }
            if n % 3 == 0 {
                bytes.truncate(place(whole.len()));
            }
            if let Err(why) = deck.read(&String::from_utf8_lossy(&bytes)) {
                assert!(why.line > 0 && !why.what.is_empty(), "{extension}: {why}");
            }
        }
    }
}

#[test]
fn peer_meshio_reads_the_same_mesh() {
    // meshio 5.3.5, where the interpreter in STRIBECK_PYTHON (or python3) has it.
    let Some(python) = python_with(&["meshio"]) else { return };
    let mesh = mesh();
    let folder = Scratch::create("decks");
    for (deck, extension) in &ALL {
        // It has elements of plane stress, and none of plane strain.
        let text = deck.write_model(&model(&mesh), "a bearing").replace("CPE", "CPS");
        std::fs::write(folder.join(format!("a.{extension}")), text).expect("it is written");
    }
    let sum = |m: &Mesh| m.x.iter().chain(&m.y).map(|v| v * v).sum::<f64>();
    let script = format!(
        "import meshio, numpy
for name in ['a.inp', 'a.msh']:
    m = meshio.read(name)
    assert len(m.points) == {} and abs((m.points ** 2).sum() - {:e}) < 1e-12, name
    cells = {{}}
    for block in m.cells:
        cells[block.type] = cells.get(block.type, 0) + len(block.data)
    assert cells == {{'quad': {}, 'triangle': {}}}, (name, cells)
print('agreed')",
        mesh.x.len(),
        sum(&mesh),
        mesh.quads.len(),
        mesh.triangles.len()
    );
    let output =
        Command::new(&python).current_dir(folder.path()).args(["-c", &script]).output().expect("it starts");
    says(&output, &["agreed"]);
    assert!(output.status.success(), "{}", said(&output));
}

/// The decks of a block that lies on another, a thousandth shorter under its load, with a triangle beside it
/// that turns, and a body that is left out. Both blocks
/// have squares of 1 mm, so that `Stfac` is k h/K, less a thousandth of their area: 0.1 E/h has 0.3 (1 − 2ν) · 0.999 = 0.11988.
#[test]
fn golden_decks_for_radioss() {
    let block = |y0| Rectangle { x0: 0.0, y0, width: 2e-3, height: 1e-3, columns: 2, rows: 1 };
    let triangle = Part {
        x: vec![4e-3, 5e-3, 4e-3],
        y: vec![0.0, 0.0, 1e-3],
        triangles: vec![[0, 1, 2]],
        ..Part::default()
    };
    let mut mesh = Mesh::new();
    let ground = mesh.add("ground", &block(0.0).part().expect("a block"));
    let upper = mesh.add("upper", &block(1e-3).part().expect("a block"));
    mesh.add("left out", &block(3e-3).part().expect("a block"));
    let wheel = mesh.add("wheel", &triangle);
    let surface = |placed: &stribeck_mesh::Placed, name: &str| placed.surface(name).expect("a side").clone();
    let (top, bottom, loaded) = (surface(&ground, "top"), surface(&upper, "bottom"), surface(&upper, "top"));
    let of_wheel: Vec<u32> = mesh.bodies[wheel.body].nodes.clone().map(|n| n as u32).collect();
    let nodes = || mesh.x.iter().zip(&mesh.y);
    let motion = Motion {
        mesh: &mesh,
        absent: vec![2],
        youngs_modulus: 200e9,
        poissons_ratio: 0.3,
        density: 7850.0,
        thickness: 0.01,
        contacts: vec![Touching {
            name: "upper on ground".into(),
            surfaces: [&bottom, &top],
            stiffness: 0.1 * 200e9 / 1e-3,
        }],
        gravity: [0.0, -9.81],
        load: (&loaded, [0.0, -5000.0]),
        guided: loaded.nodes.clone(),
        turning: (of_wheel, 50.0),
        damping: (vec![ground.body, upper.body], 1000.0),
        position: nodes().map(|(x, y)| [*x, 0.999 * y]).collect(),
        rolling: [0.0, 0.0, 0.0, 50.0].map(|rate| ([0.0; 2], rate)).to_vec(),
        duration: 1e-4,
        time_step: 1e-7,
        interval: 1e-6,
        kept: vec![("corner".into(), loaded.nodes[0])],
        remarks: vec!["left out: friction".into()],
    };
    let starter = motion.starter("two_blocks", "a block on another");
    assert!(starter.contains("   1.198800000000E-1    0.0"), "Stfac");
    let [way, run] = motion.engines("two_blocks");
    for (deck, end) in [(starter, "0000"), (way, "0001"), (run, "0002")] {
        let golden = format!("{}/../../../fixtures/golden/two_blocks_{end}.rad", env!("CARGO_MANIFEST_DIR"));
        if std::env::var_os("STRIBECK_BLESS").is_some() {
            std::fs::write(&golden, &deck).expect("writable");
        }
        assert!(std::fs::read_to_string(&golden).expect("readable") == deck, "the deck {end} has changed");
    }
}
