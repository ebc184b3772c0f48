// From the world to clip coordinates: `Camera::matrix`.
@group(0) @binding(0) var<uniform> matrix: mat4x4<f32>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) color: vec4<f32>,
}

@vertex
fn vertex(@location(0) position: vec3<f32>, @location(1) color: vec4<f32>) -> Corner {
    return Corner(matrix * vec4(position, 1.0), color);
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4<f32> {
    return corner.color;
}
