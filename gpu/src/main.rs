//! Transparency on a GPU, with wgpu. Opaque polygons are drawn first, with depth test. Then translucent
//! polygons are drawn back to front, in the order of a BSP tree.
//!
//! ```sh
//! cargo run --release -- picture.png
//! ```
//!
//! ![Three panes that cross in a column, a tilted one across them, a bubble, a beam and balls](../picture.png)
//!
//! This example needs no window. A program with a window draws the same two passes to its surface.

mod scene;
#[cfg(test)]
mod tests;

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

use binspace::BspTree;
use binspace::glam::{DVec3, dvec3};
use binspace::mesh::Triangles;
use binspace::view::Camera;
use wgpu::util::DeviceExt;

use scene::{Polygon, scene};

const BACKGROUND: [f64; 3] = [0.86, 0.90, 0.95];
/// Not sRGB: colours are blended as bytes, like in the painters of the library. Choose the format that your
/// other colours need; the order does not depend on it.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Each pixel has four samples, so edges are smooth. Every GPU supports four samples.
const SAMPLES: wgpu::MultisampleState =
    wgpu::MultisampleState { count: 4, mask: !0, alpha_to_coverage_enabled: false };

/// Position, red, green, blue and opacity.
type Vertex = [f32; 7];

fn main() -> Result<(), Box<dyn Error>> {
    let Some(path) = std::env::args_os().nth(1) else {
        return Err("give the path of the picture: cargo run --release -- picture.png".into());
    };
    let size = [1280, 800];
    let mut renderer = Renderer::new(&scene(), size)?;
    let picture = renderer.draw(&camera(dvec3(2.4, -7.2, 4.2), size)?)?;
    let file = BufWriter::new(File::create(path)?);
    let mut png = png::Encoder::new(file, size[0], size[1]);
    png.set_color(png::ColorType::Rgba);
    png.write_header()?.write_image_data(&picture)?;
    Ok(())
}

fn camera(eye: DVec3, size: [u32; 2]) -> Result<Camera, binspace::Error> {
    Camera::perspective(eye, dvec3(0.0, 0.0, 0.95), DVec3::Z, 0.56, size)
}

/// A scene on a GPU.
struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    size: [u32; 2],
    /// The picture with four samples per pixel, the picture with one, and depths.
    samples: wgpu::Texture,
    picture: wgpu::Texture,
    depths: wgpu::Texture,
    matrix: wgpu::Buffer,
    opaque: Pass,
    glass: Pass,
    /// The tree and the mesh of the glass, and lists that are reused.
    tree: BspTree,
    triangles: Triangles,
    order: Vec<u32>,
    indices: Vec<u32>,
}

impl Renderer {
    fn new(scene: &[Polygon], size: [u32; 2]) -> Result<Self, Box<dyn Error>> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;

        // Only glass is in the tree. The depth test orders opaque polygons, and in the tree they would
        // add cuts.
        let (opaque, glass): (Vec<&Polygon>, Vec<&Polygon>) =
            scene.iter().partition(|polygon| polygon.is_opaque());
        let tree = BspTree::build(glass.iter().map(|polygon| &polygon.corners))?;
        // The pieces of the glass. In a welded mesh no pixel is missed where pieces meet.
        let mesh = tree.welded_mesh()?;
        let pieces = mesh.vertices().map(|v| vertex(v.position, glass[v.polygon]));
        let pieces: Vec<Vertex> = pieces.collect();
        let triangles = mesh.triangles().clone();
        let (vertices, fans) = fans(&opaque);

        let matrix = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let target = |format, samples, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: extent(size),
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let nothing_else = wgpu::TextureUsages::empty();
        Ok(Self {
            samples: target(FORMAT, SAMPLES.count, nothing_else),
            picture: target(FORMAT, 1, wgpu::TextureUsages::COPY_SRC),
            depths: target(DEPTH, SAMPLES.count, nothing_else),
            opaque: Pass::new(&device, &matrix, &vertices, &fans, true),
            glass: Pass::new(&device, &matrix, &pieces, triangles.indices(), false),
            indices: vec![0; triangles.indices().len()],
            order: vec![],
            device,
            queue,
            size,
            matrix,
            tree,
            triangles,
        })
    }

    /// Draws a frame, and returns its pixels: red, green, blue and 255, row by row from the top.
    fn draw(&mut self, camera: &Camera) -> Result<Vec<u8>, Box<dyn Error>> {
        // Only the matrix and the indices change from frame to frame. While `BspTree::same_order` is true,
        // the indices stay valid; see the library's example `gpu_transparency`.
        let matrix = camera.matrix(0.1, 100.0).as_mat4().to_cols_array();
        self.queue.write_buffer(&self.matrix, 0, bytemuck::cast_slice(&matrix));
        let Self { tree, triangles, order, indices, .. } = self;
        triangles.write_back_to_front(tree, camera.viewpoint(), order, indices)?;
        self.queue.write_buffer(&self.glass.indices, 0, bytemuck::cast_slice(indices));

        let [samples, picture, depths] = [&self.samples, &self.picture, &self.depths]
            .map(|texture| texture.create_view(&Default::default()));
        let [r, g, b] = BACKGROUND;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &samples,
                depth_slice: None,
                resolve_target: Some(&picture),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depths,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        self.opaque.draw(&mut pass);
        self.glass.draw(&mut pass);
        drop(pass);
        self.read(encoder)
    }

    /// Runs the commands, and copies the picture back.
    fn read(&self, mut encoder: wgpu::CommandEncoder) -> Result<Vec<u8>, Box<dyn Error>> {
        let [width, height] = self.size;
        // Rows of a copy begin at multiples of 256 bytes.
        let row = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let copy = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            self.picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &copy, layout },
            extent(self.size),
        );
        self.queue.submit([encoder.finish()]);
        let (done, result) = std::sync::mpsc::channel();
        copy.map_async(wgpu::MapMode::Read, .., move |mapped| {
            // If the wait below has failed, nobody receives the result, and the error is ignored.
            let _ = done.send(mapped);
        });
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        result.recv()??;
        let bytes = copy.get_mapped_range(..)?;
        let rows = bytes.chunks(row as usize).map(|bytes| &bytes[..4 * width as usize]);
        Ok(rows.flatten().copied().collect())
    }
}

/// Triangles that are drawn in one way.
struct Pass {
    pipeline: wgpu::RenderPipeline,
    bindings: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

impl Pass {
    fn new(
        device: &wgpu::Device,
        matrix: &wgpu::Buffer,
        vertices: &[Vertex],
        indices: &[u32],
        is_opaque: bool,
    ) -> Self {
        let shader = device.create_shader_module(wgpu::include_wgsl!("shader.wgsl"));
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Vertex>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x4],
                })],
            },
            // Both sides of a polygon are drawn.
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                // Opaque polygons hide glass, so they write depth. Glass hides nothing.
                depth_write_enabled: Some(is_opaque),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: SAMPLES,
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("fragment"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::ColorTargetState {
                    format: FORMAT,
                    blend: (!is_opaque).then_some(wgpu::BlendState::ALPHA_BLENDING),
                    write_mask: wgpu::ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        });
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: matrix.as_entire_binding() }],
        });
        let buffer = |contents, usage| {
            let usage = usage | wgpu::BufferUsages::COPY_DST;
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents,
                usage,
            })
        };
        Self {
            pipeline,
            bindings,
            vertices: buffer(bytemuck::cast_slice(vertices), wgpu::BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(indices), wgpu::BufferUsages::INDEX),
            count: indices.len() as u32,
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        if self.count == 0 {
            return; // wgpu refuses empty buffers.
        }
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
    }
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

fn vertex(position: DVec3, polygon: &Polygon) -> Vertex {
    let ([x, y, z], [r, g, b]) = (position.as_vec3().to_array(), polygon.color);
    [x, y, z, r, g, b, polygon.opacity]
}

/// Convex polygons as vertices and triangles.
fn fans(polygons: &[&Polygon]) -> (Vec<Vertex>, Vec<u32>) {
    let (mut vertices, mut indices) = (vec![], vec![]);
    for polygon in polygons {
        let first = vertices.len() as u32;
        vertices.extend(polygon.corners.iter().map(|&corner| vertex(corner, polygon)));
        let last = vertices.len() as u32 - 1;
        indices.extend((first + 1..last).flat_map(|k| [first, k, k + 1]));
    }
    (vertices, indices)
}
