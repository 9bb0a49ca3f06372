//! Adapters, and the device of one: buffers within its limits, and what its driver says.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use ninebit::shown;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

use crate::failure::Failure;

/// Columns and rows of a tile, each pixel of which is an invocation of a workgroup.
pub(crate) const TILE: u32 = 16;

/// Workgroups of a row of a dispatch. Every adapter has at least 65,535.
pub(crate) const DISPATCH_ROW: u32 = 32_768;

/// Buffers that a shader reads or writes, besides its uniform one.
const STORAGE_BUFFERS: u32 = 6;

/// Returns the adapters that the machine has, the fastest kinds first.
pub fn adapters() -> Vec<wgpu::Adapter> {
    let mut options = wgpu::InstanceDescriptor::new_without_display_handle();
    options.backends = wgpu::Backends::VULKAN;
    let instance = wgpu::Instance::new(options);
    let mut all = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    all.sort_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    all
}

/// Returns the name of an adapter, its kind and its driver.
pub fn description(adapter: &wgpu::Adapter) -> String {
    let info = adapter.get_info();
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => "a card",
        wgpu::DeviceType::IntegratedGpu => "part of the CPU's chip",
        wgpu::DeviceType::VirtualGpu => "a virtual GPU",
        wgpu::DeviceType::Cpu => "a driver that runs on the CPU",
        wgpu::DeviceType::Other => "of another kind",
    };
    let text = format!("{}, {kind}: {} {}", info.name, info.driver, info.driver_info);
    shown::name(&text).into_owned()
}

/// Returns the wanted one of all adapters: by its number, or by a part of its name; without a wish the first.
fn chosen(all: Vec<wgpu::Adapter>, wanted: Option<&str>) -> Result<wgpu::Adapter, Failure> {
    let count = shown::count(all.len() as u64, "adapter");
    let missing = match wanted {
        _ if all.is_empty() => "no adapter offers Vulkan here".to_string(),
        Some(wanted) => format!("none of {count} is `{wanted}`; `ninebit-gpu adapters` lists them"),
        None => String::new(),
    };
    let number = wanted.and_then(|wanted| wanted.parse::<usize>().ok());
    let is_wanted = |(n, adapter): &(usize, wgpu::Adapter)| match (number, wanted) {
        (Some(number), _) => *n == number,
        (None, Some(wanted)) => adapter.get_info().name.to_lowercase().contains(&wanted.to_lowercase()),
        (None, None) => true,
    };
    let found = all.into_iter().enumerate().find(is_wanted);
    found.map(|(_, adapter)| adapter).ok_or_else(|| Failure::no_adapter(missing))
}

/// What the driver has said so far that nobody has asked for.
type Complaint = Arc<Mutex<Option<String>>>;

/// The pipeline of a text, and that for tiles which a triangle covers.
pub(crate) type Pipelines = [wgpu::ComputePipeline; 2];

/// The device of an adapter.
#[derive(Debug)]
pub struct Gpu {
    /// Name and driver of the adapter.
    pub name: String,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    limits: wgpu::Limits,
    complaint: Complaint,
    /// Pipelines of texts for every draw: these compile for long.
    pub(crate) pipelines: Mutex<HashMap<String, Pipelines>>,
}

impl Gpu {
    /// Opens the wanted adapter: its number, or a part of its name; without a wish the first one.
    ///
    /// # Errors
    /// There is none, or it lacks what drawing needs.
    pub fn open(wanted: Option<&str>) -> Result<Gpu, Failure> {
        let adapter = chosen(adapters(), wanted)?;
        let (name, limits) = (description(&adapter), adapter.limits());
        let needs = [
            ("storage buffers of a shader", limits.max_storage_buffers_per_shader_stage, STORAGE_BUFFERS),
            ("invocations of a workgroup", limits.max_compute_invocations_per_workgroup, TILE * TILE),
            ("workgroups of a dispatch", limits.max_compute_workgroups_per_dimension, DISPATCH_ROW),
        ];
        for (what, has, needed) in needs {
            if has < needed {
                return Err(Failure::limit(format!("{name} allows {has} {what}, and {needed} are needed")));
            }
        }
        let options = wgpu::DeviceDescriptor { required_limits: limits.clone(), ..Default::default() };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&options)).map_err(|error| Failure::driver(error.to_string()))?;
        let complaint = Complaint::default();
        let heard = Arc::clone(&complaint);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            heard.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| error.to_string());
        }));
        Ok(Gpu { name, device, queue, limits, complaint, pipelines: Mutex::default() })
    }

    /// Runs a shader of its own whose bindings 0 and 1 are the given words and as many results as asked for.
    ///
    /// # Errors
    /// What the driver says.
    pub fn run(&self, text: &str, given: &[u32], results: usize, workgroups: u32) -> Result<Vec<u32>, Failure> {
        let module = self.module(text);
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        self.check()?;
        let usage = wgpu::BufferUsages::STORAGE;
        let given = self.buffer("the given words", given, usage)?;
        let found = self.buffer("the results", &vec![0; results], usage | wgpu::BufferUsages::COPY_SRC)?;
        let entries = [(0, &given), (1, &found)]
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
        let layout = &pipeline.get_bind_group_layout(0);
        let group =
            self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries });
        let mut encoder = self.encoder();
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(workgroups, 1, 1);
        drop(pass);
        self.queue.submit([encoder.finish()]);
        self.read(&found)
    }

    /// Compiles a shader.
    pub(crate) fn module(&self, text: &str) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Wgsl(Cow::Borrowed(text));
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    }

    /// Allows buffers of so many bytes only, as smaller adapters do.
    #[must_use]
    pub fn within(mut self, bytes: u64) -> Gpu {
        self.limits.max_buffer_size = self.limits.max_buffer_size.min(bytes);
        self
    }

    /// Returns what the driver has complained of since the last time.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let said = self.complaint.lock().unwrap_or_else(PoisonError::into_inner).take();
        said.map_or(Ok(()), |said| Err(Failure::driver(format!("{}: {said}", self.name))))
    }

    /// Makes a buffer of words. `what` names them where they are too many.
    pub(crate) fn buffer(&self, what: &str, words: &[u32], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, Failure> {
        let (bytes, uniform) = (4 * words.len() as u64, usage.contains(wgpu::BufferUsages::UNIFORM));
        let binding = if uniform { self.limits.max_buffer_size } else { self.limits.max_storage_buffer_binding_size };
        let most = binding.min(self.limits.max_buffer_size);
        if bytes > most {
            let message = format!("{what} take {bytes} bytes; {} allows {most} in one buffer", self.name);
            return Err(Failure::limit(message));
        }
        let buffer = self.device.create_buffer_init(&BufferInitDescriptor {
            label: None,
            // No buffer is empty.
            contents: bytemuck::cast_slice(if words.is_empty() { &[0] } else { words }),
            usage,
        });
        self.check()?;
        Ok(buffer)
    }

    /// Returns the alignment of offsets into uniform buffers in words.
    pub(crate) fn alignment(&self) -> usize {
        (self.limits.min_uniform_buffer_offset_alignment as usize / 4).max(4)
    }

    /// Returns the words of a buffer, after all work that was submitted.
    pub(crate) fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u32>, Failure> {
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let options = wgpu::BufferDescriptor { label: None, size: buffer.size(), usage, mapped_at_creation: false };
        let copy = self.device.create_buffer(&options);
        let mut encoder = self.encoder();
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        copy.map_async(wgpu::MapMode::Read, .., |_| ());
        self.wait()?;
        let bytes = copy.get_mapped_range(..).map_err(|error| Failure::driver(error.to_string()))?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    pub(crate) fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Waits until everything that was submitted is done.
    pub(crate) fn wait(&self) -> Result<(), Failure> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        waited.map(|_| ()).map_err(|error| Failure::driver(error.to_string()))
    }
}
